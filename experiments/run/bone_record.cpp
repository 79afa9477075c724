#include "experiments/run/bone_record.hpp"

namespace experiments {

const analysis::Columns<BonePlace> bone_columns = {
    {"bone", &BonePlace::bone, "", "name of the bone"},
    {"parent", &BonePlace::parent, "", "name of its parent; empty for a root"},
    {"head_x_m", [](auto& bone) -> decltype(auto) { return (bone.head.x()); }, "m", "x of the bone's beginning"},
    {"head_y_m", [](auto& bone) -> decltype(auto) { return (bone.head.y()); }, "m", "y of the bone's beginning"},
    {"head_z_m", [](auto& bone) -> decltype(auto) { return (bone.head.z()); }, "m", "z of the bone's beginning"},
    {"tail_x_m", [](auto& bone) -> decltype(auto) { return (bone.tail.x()); }, "m", "x of the bone's end"},
    {"tail_y_m", [](auto& bone) -> decltype(auto) { return (bone.tail.y()); }, "m", "y of the bone's end"},
    {"tail_z_m", [](auto& bone) -> decltype(auto) { return (bone.tail.z()); }, "m", "z of the bone's end"}};

const analysis::Columns<PosedBone> posed_bone_columns =
    analysis::Columns<PosedBone>{{"frame", &PosedBone::frame, "", "number of the frame, from 0"},
                                 {"time_s", &PosedBone::time_s, "s", "time since the motion began"}} +
    analysis::within(&PosedBone::place, bone_columns);

const analysis::Columns<BoundVertex> bound_vertex_columns = {
    {"vertex", &BoundVertex::vertex, "", "number of the vertex, from 0"},
    {"bone", &BoundVertex::bone, "", "the vertex's nearest bone (Sec. 2.1)"},
    {"parameter", &BoundVertex::parameter, "", "position of the vertex's projection on that bone: 0 at its head, 1 at its tail"},
    {"rest_distance_m", &BoundVertex::rest_distance_m, "m", "distance to the bone at rest"},
    {"blended", &BoundVertex::blended, "", "Eq. 2 blends the vertex between bones"},
    {"jiggles", &BoundVertex::jiggles, "", "the vertex is farther from its bone than the mean"}};

namespace {

std::string parent_of(const pbs::Skeleton& skeleton, const pbs::Bone& bone)
{
    return bone.parent < 0 ? "" : skeleton.bones[bone.parent].name;
}

}  // namespace

std::vector<BonePlace> bones_at_rest(const pbs::Skeleton& skeleton)
{
    std::vector<BonePlace> bones;
    for (const pbs::Bone& bone : skeleton.bones) bones.push_back({bone.name, parent_of(skeleton, bone), bone.head, bone.tail});
    return bones;
}

void add_bones(std::vector<PosedBone>& bones, int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose)
{
    for (std::size_t j = 0; j < skeleton.bones.size(); ++j) {
        const pbs::Bone& bone = skeleton.bones[j];
        bones.push_back({frame, time_s, {bone.name, parent_of(skeleton, bone), pose[j] * bone.head, pose[j] * bone.tail}});
    }
}

std::vector<BoundVertex> bound_vertices(const pbs::Character& character)
{
    const pbs::BoneBinding& binding = character.binding;
    const std::vector<bool> jiggles = pbs::jiggle_zone(binding);
    std::vector<BoundVertex> vertices;
    for (std::size_t v = 0; v < binding.bone.size(); ++v)
        vertices.push_back({int(v), character.skeleton.bones[binding.bone[v]].name, binding.parameter(v), binding.distance(v),
                            bool(character.blended[v]), jiggles[v]});
    return vertices;
}

}  // namespace experiments
