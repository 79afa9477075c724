#include "experiments/clips/clip.hpp"

#include "experiments/clips/body_axes.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/nearest_rotation.hpp"
#include "pbs/system/files.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace pbs {
namespace {

constexpr double farthest = 1e9;            // [clip's units]
constexpr double key_rate_hz = 120.0;       // at which motions are sampled whose keys are not frames
constexpr double most_frames = 10'000'000;  // a day at 115 Hz
constexpr double least_turn_deg = 5.0;      // of a joint in an animation that is a motion
constexpr double same_pose_deg = 5.0;       // of every joint, between the bind pose and that of the nodes
constexpr double same_size = 1e-3;          // relative, of single precision with some products
constexpr int frames_looked_at = 31;        // of each animation, to find the one that moves

using Rotations = std::vector<Eigen::Quaterniond>;

// The rotation of each node in the scene, without its scale.
Rotations rotations_of(const std::vector<Eigen::Affine3d>& nodes)
{
    Rotations rotations;
    for (const Eigen::Affine3d& node : nodes) {
        const double size = std::cbrt(std::abs(node.linear().determinant()));
        rotations.emplace_back(
            nearest_rotation(size > 0.0 ? Eigen::Matrix3d(node.linear() / size) : Eigen::Matrix3d(node.linear())));
    }
    return rotations;
}

// Turns of the nodes from the zero pose, each relative to that of its parent.
Rotations local_turns(const Rig& rig, const Rotations& zero, const Rotations& now)
{
    Rotations turns, local;
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
        turns.push_back((now[n] * zero[n].conjugate()).normalized());
        const int parent = rig.nodes[n].parent;
        local.push_back(parent < 0 ? turns[n] : (turns[parent].conjugate() * turns[n]).normalized());
    }
    return local;
}

Positions places_of(const std::vector<Eigen::Affine3d>& nodes)
{
    Positions places(static_cast<Eigen::Index>(nodes.size()), 3);
    for (std::size_t n = 0; n < nodes.size(); ++n) places.row(static_cast<Eigen::Index>(n)) = nodes[n].translation();
    return places;
}

// The same bind pose as it stands in the scene. The root's own rotation tells that only where the nodes rest in the
// bind pose; otherwise the pose of the mesh's coordinates is taken, with the least rotation that carries its upward
// axis to that of the nodes.
std::vector<Eigen::Affine3d> upright(const std::vector<Eigen::Affine3d>& bound,
                                     const std::vector<Eigen::Affine3d>& rest, const std::set<int>& joints,
                                     const Eigen::Affine3d& mesh_to_rest, const BodyJoints& body)
{
    const Rotations rotations = rotations_of(bound), resting = rotations_of(rest);
    const bool rests_as_bound = std::ranges::all_of(
        joints, [&](int n) { return rotations[n].angularDistance(resting[n]) <= same_pose_deg * M_PI / 180.0; });
    if (rests_as_bound || !(std::abs(mesh_to_rest.linear().determinant()) > 0.0)) return bound;
    std::vector<Eigen::Affine3d> in_mesh;
    for (const Eigen::Affine3d& node : bound) in_mesh.push_back(mesh_to_rest.inverse() * node);
    const auto in_mesh_trunk = trunk_directions(places_of(in_mesh), body),
               in_scene = trunk_directions(places_of(rest), body);
    if (!in_mesh_trunk || !in_scene) return bound;
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(body_axes(*in_mesh_trunk).col(1), nearest_axis(in_scene->up));
    for (Eigen::Affine3d& node : in_mesh) node = turn * node;
    return in_mesh;
}

double length_of_bones(const Rig& rig, const std::vector<Eigen::Affine3d>& nodes, const std::set<int>& joints)
{
    double length = 0.0;
    for (const int joint : joints)
        if (const int parent = rig.nodes[joint].parent; joints.contains(parent))
            length += (nodes[joint].translation() - nodes[parent].translation()).norm();
    return length;
}

// Joints where their skin was bound; other nodes where they rest, below them.
std::vector<Eigen::Affine3d> zero_pose_of(const Rig& rig, const BodyJoints& body)
{
    const std::vector<Eigen::Affine3d> rest = node_transforms(rig, nullptr, 0.0);
    if (std::ranges::all_of(rig.meshes, [](const RigMesh& mesh) { return mesh.joints.empty(); })) return rest;
    const RigBinding binding = bind_rig(rig, nullptr, 1.0 / rig.unit_m);
    std::vector<Eigen::Affine3d> zero = rest;
    std::set<int> joints;
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
        const int parent = rig.nodes[n].parent;
        if (const auto bound = binding.bind.find(static_cast<int>(n)); bound != binding.bind.end()) {
            zero[n] = bound->second;
            joints.insert(static_cast<int>(n));
        } else if (parent >= 0) {
            const bool has_inverse = std::abs(rest[parent].linear().determinant()) > 0.0;
            zero[n] = zero[parent] *
                      (has_inverse ? Eigen::Affine3d(rest[parent].inverse() * rest[n]) : Eigen::Affine3d::Identity());
        }
    }
    const SkinJoint& joint = binding.meshes.front().joints.front();
    std::vector<Eigen::Affine3d> posed =
        upright(zero, rest, joints, binding.bind.at(joint.node) * joint.inverse_bind, body);
    // Where the bind pose has another size than the nodes, the path is in the unit of the nodes.
    const double length = length_of_bones(rig, posed, joints), length_at_rest = length_of_bones(rig, rest, joints);
    if (length > 0.0 && std::abs(length_at_rest / length - 1.0) > same_size)
        for (Eigen::Affine3d& node : posed) node = Eigen::Scaling(length_at_rest / length) * node;
    return posed;
}

// The largest turn of a node in its parent from the start of an animation [deg].
double largest_turn_deg(const Rig& rig, const RigAnimation& animation)
{
    const Rotations start = rotations_of(node_transforms(rig, &animation, animation.start_s));
    double largest = 0.0;
    for (int frame = 1; frame < frames_looked_at; ++frame) {
        const double time_s =
            animation.start_s + (animation.end_s - animation.start_s) * frame / (frames_looked_at - 1);
        for (const Eigen::Quaterniond& turn :
             local_turns(rig, start, rotations_of(node_transforms(rig, &animation, time_s))))
            largest = std::max(largest, turn.angularDistance(Eigen::Quaterniond::Identity()));
    }
    return largest * 180.0 / M_PI;
}

const RigAnimation& moving_animation_of_clip(const Rig& rig, Clip& clip)
{
    const RigAnimation* taken = nullptr;
    double largest_deg = -1.0;
    std::vector<std::string> others;
    for (const RigAnimation& animation : rig.animations) {
        const double turn_deg = largest_deg > least_turn_deg ? 0.0 : largest_turn_deg(rig, animation);
        if (largest_deg <= least_turn_deg && turn_deg > largest_deg) {
            taken = &animation;
            largest_deg = turn_deg;
        }
    }
    for (const RigAnimation& animation : rig.animations)
        if (&animation != taken) others.push_back(animation.name);
    const std::string why = largest_deg > least_turn_deg ? "the first one that turns a joint by more than "
                                                         : "since it turns a joint most, although by no more than ";
    if (!others.empty())
        clip.remarks.push_back(
            rig.file + ": it has " + std::to_string(rig.animations.size()) + " animations; " + taken->name +
            " is taken, " + why + number_text(least_turn_deg) +
            " degrees (motion.animation = NAME of a scene, or --animation FILE:NAME of try, takes another one: " +
            name_list(others) + ")");
    return *taken;
}

// The curves of a node of an FBX file by which it turns or moves.
std::vector<FbxCurve> fbx_curves(const NodeTracks& tracks)
{
    std::vector<FbxCurve> curves;
    for (const int property : {0, 1})  // Lcl Translation, Lcl Rotation
        for (const std::optional<FbxCurve>& curve : tracks.fbx[static_cast<std::size_t>(property)])
            if (curve) curves.push_back(*curve);
    return curves;
}

std::set<int> moved_nodes(const RigAnimation& animation)
{
    std::set<int> nodes;
    for (const NodeTracks& tracks : animation.nodes)
        if (tracks.rotation || tracks.translation || !fbx_curves(tracks).empty()) nodes.insert(tracks.node);
    return nodes;
}

// Two nodes that the animation moves need two names; any other node of a name that occurs is numbered.
void add_joints(const Rig& rig, const std::set<int>& moved, Clip& clip)
{
    std::set<std::string> names;
    for (const int node : moved)
        if (!names.insert(rig.nodes[node].name).second)
            throw InputError(rig.file, 0, "joint", rig.nodes[node].name,
                             "two moving joints have this name: expected one name per joint");
    for (int n = 0; n < static_cast<int>(rig.nodes.size()); ++n) {
        std::string name = rig.nodes[n].name;
        for (int number = 2; !moved.contains(n) && !names.insert(name).second; ++number)
            name = rig.nodes[n].name + " (" + std::to_string(number) + ")";
        clip.joints.push_back(name);
        clip.parent.push_back(rig.nodes[n].parent);
        clip.body_parts.push_back(rig.nodes[n].body_part);
    }
}

// Whether the node stays where a key puts it until the next one.
bool holds(const NodeTracks& tracks)
{
    const auto is_step = [](const std::optional<KeyTrack>& track) {
        return track && track->interpolation == Interpolation::step;
    };
    const auto is_constant = [](const FbxCurve& curve) {
        return curve.front().interpolation == FbxInterpolation::constant;
    };
    return is_step(tracks.rotation) || is_step(tracks.translation) ||
           std::ranges::any_of(fbx_curves(tracks), is_constant);
}

Clip clip_of_rig(const std::string& path, const std::string& name)
{
    const Rig rig = read_any_rig(path);
    Clip clip;
    clip.name = path;
    if (rig.animations.empty()) throw InputError(path, 0, "animations", "0", "holds no motion");
    const RigAnimation& animation = name.empty() ? moving_animation_of_clip(rig, clip) : *find_animation(rig, name);
    const std::set<int> moved = moved_nodes(animation);
    if (moved.empty()) throw InputError(path, 0, "animation", animation.name, "its motion moves none of its joints");
    add_joints(rig, moved, clip);
    clip.holds.assign(rig.nodes.size(), false);
    for (const NodeTracks& tracks : animation.nodes) clip.holds[tracks.node] = holds(tracks);

    const std::vector<Eigen::Affine3d> zero = zero_pose_of(rig, body_joints(clip));
    const Rotations zero_rotations = rotations_of(zero);
    clip.zero_pose = places_of(zero);
    clip.frame_time_s = 1.0 / key_rate_hz;
    const double start_s = std::min(animation.start_s, 0.0);
    const double frames = std::floor((animation.end_s - start_s) * key_rate_hz + 1e-6) + 1.0;
    if (!(frames <= most_frames))
        throw InputError(path, 0, "frames", number_text(frames),
                         "expected 1 to " + std::to_string(static_cast<int>(most_frames)));
    for (int frame = 0; frame < static_cast<int>(frames); ++frame) {
        const std::vector<Eigen::Affine3d> nodes = node_transforms(rig, &animation, start_s + frame / key_rate_hz);
        clip.local.push_back(local_turns(rig, zero_rotations, rotations_of(nodes)));
        clip.places.push_back(places_of(nodes));
    }
    return clip;
}

}  // namespace

void check_clip(const Clip& clip)
{
    const auto require_near = [&](const Positions& points) {
        if (!(points.array().abs() <= farthest).all())
            throw InputError(clip.name, 0, "positions", "", "expected finite numbers of at most 1e9");
    };
    require_near(clip.zero_pose);
    for (const auto& frame : clip.local)
        for (const Eigen::Quaterniond& rotation : frame)
            if (!(std::abs(rotation.norm() - 1.0) < 1e-3))
                throw InputError(clip.name, 0, "", "", "damaged: the reader's answer is not a whole clip");
    for (const Positions& frame : clip.places) require_near(frame);
    if (!(clip.frame_time_s >= shortest_frame_s && clip.frame_time_s <= longest_frame_s))
        throw InputError(clip.name, 0, "frame time", std::to_string(clip.frame_time_s), "expected 1e-6 to 1000 s");
}

Clip read_clip(const std::string& path, const std::string& animation)
{
    if (!is_rig_file(path)) {
        const std::string text = read_text_file(path);
        if (!is_bvh(text, path))
            throw InputError(path, 0, "", "",
                             "no clip: expected BVH, glTF (.glb, .gltf), FBX (.fbx) or COLLADA (.dae, .zae)");
        if (!animation.empty())
            throw InputError(path, 0, "animation", animation, "expected no name: a BVH file holds one motion");
        Clip clip = read_bvh(text, path);
        check_clip(clip);
        return clip;
    }
    Clip clip = clip_of_rig(path, animation);
    check_clip(clip);
    return clip;
}

}  // namespace pbs
