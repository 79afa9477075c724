#include "experiments/run/drawn_frames.hpp"

#include "experiments/meshes/mesh_io.hpp"

#include <cmath>

namespace experiments {
namespace {

std::string parent_of(const pbs::Skeleton& skeleton, const pbs::Bone& bone)
{
    return bone.parent < 0 ? "" : skeleton.bones[bone.parent].name;
}

}  // namespace

const analysis::Columns<BonePlace> bone_columns = [] {
    auto columns = MEMBER_COLUMNS(BonePlace, bone, parent);
    for (const auto& [name, end] : {std::pair("head_", &BonePlace::head), std::pair("tail_", &BonePlace::tail)})
        for (int axis = 0; axis < 3; ++axis)
            columns.emplace_back(
                std::string(name) + "xyz"[axis] + "_m",
                [ end = end, axis ](auto& bone) -> auto& { return (bone.*end)(axis); });
    return columns;
}();

const analysis::Columns<PosedBone> posed_bone_columns =
    MEMBER_COLUMNS(PosedBone, frame, time_s) + analysis::within(&PosedBone::place, bone_columns);

const analysis::Columns<BoundVertex> bound_vertex_columns =
    MEMBER_COLUMNS(BoundVertex, vertex, bone, parameter, rest_distance_m, blended, jiggles);

std::vector<BonePlace> bones_at_rest(const pbs::Skeleton& skeleton)
{
    std::vector<BonePlace> bones;
    for (const pbs::Bone& bone : skeleton.bones)
        bones.push_back({bone.name, parent_of(skeleton, bone), bone.head, bone.tail});
    return bones;
}

void add_bones(std::vector<PosedBone>& bones, int frame, double time_s, const pbs::Skeleton& skeleton,
               const pbs::Pose& pose)
{
    for (std::size_t j = 0; j < skeleton.bones.size(); ++j) {
        const pbs::Bone& bone = skeleton.bones[j];
        bones.push_back(
            {frame, time_s, {bone.name, parent_of(skeleton, bone), pose[j] * bone.head, pose[j] * bone.tail}});
    }
}

std::vector<BoundVertex> bound_vertices(const pbs::Character& character)
{
    const pbs::BoneBinding& binding = character.binding;
    const std::vector<bool> jiggles = pbs::jiggle_zone(binding);
    std::vector<BoundVertex> vertices;
    for (std::size_t v = 0; v < binding.bone.size(); ++v)
        vertices.push_back({int(v), character.skeleton.bones[binding.bone[v]].name, binding.parameter(v),
                            binding.distance(v), bool(character.blended[v]), jiggles[v]});
    return vertices;
}

const analysis::Columns<EmbeddedPoint> embedding_columns = [] {
    auto columns = MEMBER_COLUMNS(EmbeddedPoint, point, tet);
    for (const int k : {0, 1, 2, 3})
        columns.emplace_back(
            "barycentric_" + std::to_string(k), [k](auto& at) -> auto& { return at.barycentric[k]; });
    columns.emplace_back("joint_share", &EmbeddedPoint::joint_share);
    return columns;
}();

analysis::CsvTable embedding_table(const pbs::EmbeddedSurface& surface, const JointShares& of_joints)
{
    std::vector<EmbeddedPoint> points;
    for (int point = 0; point < surface.tet.size(); ++point) {
        const auto share = surface.barycentric.row(point);
        points.push_back({point, surface.tet(point), {share(0), share(1), share(2), share(3)}});
    }
    for (const auto& [point, share] : of_joints) points[static_cast<std::size_t>(point)].joint_share = share;
    return table_of(embedding_columns, points);
}

void write_surface(const pbs::EmbeddedSurface& surface, const pbs::TetMesh& mesh, const JointShares& of_joints,
                   const std::string& folder)
{
    pbs::write_vtp(folder + "/surface_rest.vtp", pbs::embedded_positions(surface, mesh.rest, mesh.tets),
                   surface.triangles);
    embedding_table(surface, of_joints).write(folder + "/embedding.csv");
}

const analysis::Columns<DeformerDistance> distance_columns =
    MEMBER_COLUMNS(DeformerDistance, frame, time_s, deformer, other, of, points, rms_mm, largest_mm);

void DistanceRecord::add(int frame, double time_s, const std::string& label, const std::string& owner,
                         const pbs::Positions& points)
{
    if (frame != frame_) before_.clear();
    frame_ = frame;
    for (const auto& [other, there] : before_) {
        const Eigen::VectorXd squares = (points - there).rowwise().squaredNorm();
        distances_.push_back({frame, time_s, label, other, owner, static_cast<int>(points.rows()),
                              1e3 * std::sqrt(squares.mean()), 1e3 * std::sqrt(squares.maxCoeff())});
    }
    before_.emplace_back(label, points);
}

}  // namespace experiments
