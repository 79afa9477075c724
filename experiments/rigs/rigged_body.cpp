#include "experiments/rigs/rigged_body.hpp"

#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <set>

namespace pbs {
namespace {

constexpr double same_place = 1e-3;  // of the skeleton's extent: nearer joints do not define a direction
constexpr double least_agreement =
    0.5;  // of the mean distance of the joints below: a middle nearer than that is no direction
constexpr double share_to_farthest = 0.9;  // a bone without a joint below ends inside the flesh
constexpr double share_of_parent = 0.3;    // the length of a bone whose points say nothing about it

// A closed body encloses at least this part of (its area)^(3/2): 0.02 for a tube forty times as long as it is thick.
constexpr double least_closed = 1e-3;

// A joint below a bone, and the weight of all that moves with it.
struct JointBelow {
    Vec3 place;
    double weight = 0.0;
};

// The tails of all bones of a body, whose heads, surface and skin are known: a rig's file says only where its joints
// are. A bone ends
// - at the joint below its own joint, whether that joint is a bone or not;
// - where several are below, in their middle, or at the one that moves most if they lie on opposite sides;
// - where none is below, at nine tenths of the way to the farthest point that it moves, in the direction of the middle
//   of these points, or of its parent if that middle is at the joint.
class Tails {
public:
    Tails(const Rig& rig, RiggedBody& body)
        : rig_(rig), body_(body), weight_(rig.nodes.size()), has_mesh_(rig.nodes.size())
    {
        place_ = bind_places(node_transforms(rig, nullptr, 0.0));
        extent_m_ = diagonal_m(body.surface);
        for (const RigMesh& mesh : rig.meshes) has_mesh_[mesh.node] = true;
        for (std::size_t e = 0; e < body.skin.bone.size(); ++e)
            weight_[body.node[body.skin.bone[e]]] += body.skin.weight[e];
        // children come after their parents: one pass sums the subtrees
        for (std::size_t n = rig.nodes.size(); n-- > 0;)
            if (const int parent = rig.nodes[n].parent; parent >= 0) weight_[parent] += weight_[n];
    }

    void set()
    {
        for (std::size_t b = 0; b < body_.skeleton.bones.size(); ++b) {
            const std::vector<JointBelow> below = joints_below(body_.node[b]);
            Bone& bone = body_.skeleton.bones[b];
            bone.tail = below.empty() ? tail_from_points(static_cast<int>(b)) : tail_from_joints(bone.head, below);
        }
    }

private:
    // Nodes in the bind pose: joints where they were bound, others as they lie at rest relative to the node above.
    std::vector<Eigen::Affine3d> bind_places(const std::vector<Eigen::Affine3d>& rest) const
    {
        std::vector<Eigen::Affine3d> places = rest;
        for (std::size_t n = 0; n < places.size(); ++n) {
            const int parent = rig_.nodes[n].parent;
            if (const auto bound = body_.binding.bind.find(static_cast<int>(n)); bound != body_.binding.bind.end())
                places[n] = bound->second;
            else if (parent >= 0)
                places[n] = places[parent] * rest[parent].inverse() * rest[n];
        }
        return places;
    }

    std::vector<JointBelow> joints_below(int node) const
    {
        std::vector<JointBelow> below;
        for (std::size_t n = static_cast<std::size_t>(node) + 1; n < rig_.nodes.size(); ++n) {
            if (rig_.nodes[n].parent != node || has_mesh_[n]) continue;
            const Vec3 place = place_[n].translation();
            if ((place - place_[node].translation()).norm() > same_place * extent_m_) {
                below.push_back({place, weight_[n]});
            } else {  // a joint at the same place: what is below it counts
                const std::vector<JointBelow> farther = joints_below(static_cast<int>(n));
                below.insert(below.end(), farther.begin(), farther.end());
            }
        }
        return below;
    }

    static Vec3 tail_from_joints(const Vec3& head, const std::vector<JointBelow>& below)
    {
        Vec3 middle = Vec3::Zero();
        double distance = 0.0;
        for (const JointBelow& joint : below) {
            middle += joint.place / static_cast<double>(below.size());
            distance += (joint.place - head).norm() / static_cast<double>(below.size());
        }
        if ((middle - head).norm() >= least_agreement * distance) return middle;
        return std::ranges::max_element(below, {}, &JointBelow::weight)->place;
    }

    Vec3 tail_from_points(int b) const
    {
        const Bone& bone = body_.skeleton.bones[b];
        Vec3 middle = Vec3::Zero();
        double sum = 0.0;
        for (int p = 0; p < body_.skin.vertices(); ++p)
            for (int e = body_.skin.first[p]; e < body_.skin.first[p + 1]; ++e)
                if (body_.skin.bone[e] == b) {
                    middle += body_.skin.weight[e] * Vec3(body_.surface.row(p));
                    sum += body_.skin.weight[e];
                }
        Vec3 along = middle / sum - bone.head;
        double parent_m = extent_m_;
        if (bone.parent >= 0) {
            const Bone& parent = body_.skeleton.bones[bone.parent];
            parent_m = (parent.tail - parent.head).norm();
            if (along.norm() <= same_place * extent_m_) along = parent.tail - parent.head;
        }
        if (along.norm() <= same_place * extent_m_) along = Vec3::UnitY();
        along.normalize();
        const double farthest_m = farthest_point(b, along);
        return bone.head +
               (farthest_m > same_place * extent_m_ ? share_to_farthest * farthest_m : share_of_parent * parent_m) *
                   along;
    }

    // Among the points that the bone moves more than all others together, or among all that it moves if there are none.
    double farthest_point(int b, const Vec3& along) const
    {
        double farthest_m = 0.0, farthest_of_any_m = 0.0;
        for (int p = 0; p < body_.skin.vertices(); ++p)
            for (int e = body_.skin.first[p]; e < body_.skin.first[p + 1]; ++e) {
                if (body_.skin.bone[e] != b) continue;
                const double distance_m = along.dot(Vec3(body_.surface.row(p)) - body_.skeleton.bones[b].head);
                farthest_of_any_m = std::max(farthest_of_any_m, distance_m);
                if (body_.skin.weight[e] > 0.5) farthest_m = std::max(farthest_m, distance_m);
            }
        return farthest_m > 0.0 ? farthest_m : farthest_of_any_m;
    }

    const Rig& rig_;
    RiggedBody& body_;
    std::vector<Eigen::Affine3d> place_;  // of each node in rest space
    std::vector<double> weight_;          // of each node with all nodes below it
    std::vector<bool> has_mesh_;
    double extent_m_ = 0.0;
};

std::string name_of(const Rig& rig, int node)
{
    return rig.nodes[node].name.empty() ? "node " + std::to_string(node) : rig.nodes[node].name;
}

// The sum of the weights of each node's points.
std::map<int, double> weight_of_nodes(const RigBinding& binding)
{
    std::map<int, double> weights;
    for (const auto& [node, bind] : binding.bind) weights[node] = 0.0;
    for (const RigMesh& mesh : binding.meshes)
        for (std::size_t e = 0; e < mesh.skin.bone.size(); ++e)
            weights[mesh.joints[mesh.skin.bone[e]].node] += mesh.skin.weight[e];
    return weights;
}

int bone_above(int node, const Rig& rig, const std::map<int, int>& bone_of_node)
{
    for (node = rig.nodes[node].parent; node >= 0; node = rig.nodes[node].parent)
        if (const auto bone = bone_of_node.find(node); bone != bone_of_node.end()) return bone->second;
    return -1;
}

std::string unused_name(const std::string& name, const Skeleton& skeleton)
{
    if (find_bone(skeleton, name) < 0) return name;
    for (int number = 2;; ++number)
        if (const std::string other = name + " " + std::to_string(number); find_bone(skeleton, other) < 0) return other;
}

// Bones with their heads; returns the bone of each node. Nodes are in the order of the tree, so that parents come
// first.
std::map<int, int> add_bones(const Rig& rig, RiggedBody& body)
{
    std::map<int, int> bone_of_node;
    for (const auto& [node, weight] : weight_of_nodes(body.binding)) {
        if (!(weight > 0.0)) {
            body.dropped.push_back({name_of(rig, node), "moves no point"});
            continue;
        }
        const std::string name = unused_name(name_of(rig, node), body.skeleton);
        if (name != name_of(rig, node))
            body.notes.push_back("two joints are named " + name_of(rig, node) + "; one is called " + name);
        const Vec3 head = body.binding.bind.at(node).translation();
        const int parent = bone_above(node, rig, bone_of_node);
        bone_of_node[node] = static_cast<int>(body.skeleton.bones.size());
        body.skeleton.bones.push_back({name, parent, head, head, rig.nodes[node].body_part});
        body.node.push_back(node);
    }
    return bone_of_node;
}

bool is_inside_out(const Positions& points, const Triangles& triangles)
{
    const double area = surface_area(points, triangles);
    return fan_volume(points, triangles) < -least_closed * area * std::sqrt(area);
}

void turn_outward(RiggedBody& body)
{
    if (!is_inside_out(body.surface, body.triangles)) return;
    body.triangles.col(1).swap(body.triangles.col(2));
    body.notes.push_back("the surface is inside out; it is taken as the body that it encloses");
}

void add_surface(const std::map<int, int>& bone_of_node, RiggedBody& body)
{
    Eigen::Index points = 0, triangles = 0;
    for (const RigMesh& mesh : body.binding.meshes) {
        points += mesh.points.rows();
        triangles += mesh.triangles.rows();
    }
    body.surface.resize(points, 3);
    body.triangles.resize(triangles, 3);
    body.skin.first = {0};
    points = triangles = 0;
    for (const RigMesh& mesh : body.binding.meshes) {
        body.surface.middleRows(points, mesh.points.rows()) = rest_points(mesh, body.binding);
        body.look.append(mesh.look, points, triangles);
        body.triangles.middleRows(triangles, mesh.triangles.rows()) = mesh.triangles.array() + static_cast<int>(points);
        points += mesh.points.rows();
        triangles += mesh.triangles.rows();
        const int first = static_cast<int>(body.skin.bone.size());
        for (std::size_t p = 1; p < mesh.skin.first.size(); ++p) body.skin.first.push_back(first + mesh.skin.first[p]);
        for (const int joint : mesh.skin.bone) body.skin.bone.push_back(bone_of_node.at(mesh.joints[joint].node));
        body.skin.weight.insert(body.skin.weight.end(), mesh.skin.weight.begin(), mesh.skin.weight.end());
    }
    body.look.append({}, points, triangles);
}

std::vector<std::string> containers_of(const Rig& rig, const RigBinding& binding)
{
    std::set<int> containers;
    for (const auto& [node, bind] : binding.bind)
        for (int above = rig.nodes[node].parent; above >= 0; above = rig.nodes[above].parent)
            if (binding.bind.count(above) == 0) containers.insert(above);
    std::vector<std::string> names;
    for (const int node : containers) names.push_back(name_of(rig, node));
    return names;
}

bool is_rigged(const Rig& rig)
{
    return std::ranges::any_of(rig.animations, moves_nodes) ||
           std::any_of(rig.meshes.begin(), rig.meshes.end(), [](const RigMesh& mesh) { return !mesh.joints.empty(); });
}

// From rest space to the posed scene [m].
std::vector<Eigen::Affine3d> bone_transforms(const RiggedBody& body,
                                             const std::vector<Eigen::Affine3d>& node_transforms)
{
    std::vector<Eigen::Affine3d> transforms;
    for (const int node : body.node)
        transforms.push_back(Eigen::Scaling(body.binding.metres_per_unit) * node_transforms[node] *
                             body.binding.bind.at(node).inverse());
    return transforms;
}

// The way from each bone's parent to it along the joints between them [m], #bones; 0 of a root.
Eigen::VectorXd ways_from_parents(const Rig& rig, const RiggedBody& body,
                                  const std::vector<Eigen::Affine3d>& node_transforms)
{
    Eigen::VectorXd ways = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(body.node.size()));
    for (std::size_t b = 0; b < body.node.size(); ++b) {
        const int parent = body.skeleton.bones[b].parent;
        if (parent < 0) continue;
        for (int node = body.node[b]; node != body.node[static_cast<std::size_t>(parent)];
             node = rig.nodes[node].parent)
            ways(static_cast<Eigen::Index>(b)) +=
                body.binding.metres_per_unit *
                (node_transforms[node].translation() - node_transforms[rig.nodes[node].parent].translation()).norm();
    }
    return ways;
}

// As the motion is compared: with the bind pose, and where joints are between a bone and its parent, with the file's
// rest pose.
Eigen::VectorXd ways_at_rest(const Rig& rig, const RiggedBody& body)
{
    Eigen::VectorXd ways = ways_from_parents(rig, body, node_transforms(rig, nullptr, 0.0));
    for (std::size_t b = 0; b < body.node.size(); ++b) {
        const Bone& bone = body.skeleton.bones[b];
        if (bone.parent >= 0 && rig.nodes[body.node[b]].parent == body.node[static_cast<std::size_t>(bone.parent)])
            ways(static_cast<Eigen::Index>(b)) =
                (bone.head - body.skeleton.bones[static_cast<std::size_t>(bone.parent)].head).norm();
    }
    return ways;
}

// A bone that begins where its parent does has no length that could change.
void add_frame(const Eigen::VectorXd& ways, const Eigen::VectorXd& at_rest, int frame,
               std::vector<DistanceChange>& distances)
{
    for (std::size_t b = 0; b < distances.size(); ++b) {
        const auto row = static_cast<Eigen::Index>(b);
        const double change_m = ways(row) - at_rest(row);
        if (at_rest(row) > 0.0 && std::abs(change_m) > std::abs(distances[b].change_m))
            distances[b] = {.relative = change_m / at_rest(row), .change_m = change_m, .frame = frame};
    }
}

}  // namespace

RiggedBody make_rigged_body(const Rig& rig, const RigAnimation* animation, double scale)
{
    RiggedBody body;
    body.binding = bind_rig(rig, animation, scale);
    body.remarks = rig.remarks;
    body.notes = rig.notes;
    body.remarks.insert(body.remarks.end(), body.binding.remarks.begin(), body.binding.remarks.end());
    const std::map<int, int> bone_of_node = add_bones(rig, body);
    add_surface(bone_of_node, body);
    turn_outward(body);
    if (!is_rigged(rig)) {
        body.skeleton.bones.clear();
        body.node.clear();
        return body;
    }
    body.containers = containers_of(rig, body.binding);
    Tails(rig, body).set();
    for (const Eigen::Isometry3d& bone : rigid_pose(body, node_transforms(rig, nullptr, 0.0)))
        body.bind_pose_deg = std::max(body.bind_pose_deg, Eigen::AngleAxisd(bone.linear()).angle() * 180.0 / M_PI);
    return body;
}

Positions artist_points(const RiggedBody& body, const std::vector<Eigen::Affine3d>& node_transforms,
                        const RigAnimation* animation, double time_s)
{
    Positions points(body.surface.rows(), 3);
    Eigen::Index first = 0;
    for (const RigMesh& mesh : body.binding.meshes) {
        points.middleRows(first, mesh.points.rows()) =
            body.binding.metres_per_unit *
            skinned_points(mesh, node_transforms, morphed_points(mesh, animation, time_s));
        first += mesh.points.rows();
    }
    return points;
}

Positions artist_points(const RiggedBody& body, const Pose& pose)
{
    const auto nodes = static_cast<std::size_t>(body.binding.bind.rbegin()->first) + 1;
    std::vector<Eigen::Affine3d> transforms(nodes, Eigen::Affine3d::Identity());
    for (std::size_t b = 0; b < body.node.size(); ++b)
        transforms[body.node[b]] =
            Eigen::Scaling(1.0 / body.binding.metres_per_unit) * pose[b] * body.binding.bind.at(body.node[b]);
    return artist_points(body, transforms);
}

Pose rigid_pose(const RiggedBody& body, const std::vector<Eigen::Affine3d>& node_transforms, double* stretch)
{
    Pose pose;
    const std::vector<Eigen::Affine3d> transforms = bone_transforms(body, node_transforms);
    for (std::size_t b = 0; b < transforms.size(); ++b) {
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(transforms[b].linear(), Eigen::ComputeFullU | Eigen::ComputeFullV);
        Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
        if (rotation.determinant() < 0.0)
            rotation = svd.matrixU() * Vec3(1.0, 1.0, -1.0).asDiagonal() * svd.matrixV().transpose();
        if (stretch) *stretch = std::max(*stretch, (svd.singularValues().array() - 1.0).abs().maxCoeff());
        const Vec3& head = body.skeleton.bones[b].head;
        Eigen::Isometry3d rigid = Eigen::Isometry3d::Identity();
        rigid.linear() = rotation;
        rigid.translation() = transforms[b] * head - rotation * head;
        pose.push_back(rigid);
    }
    return pose;
}

RigMotion rig_motion(const Rig& rig, const RiggedBody& body, const RigAnimation& animation,
                     const MotionSampling& sampling)
{
    RigMotion made;
    made.distances.resize(body.node.size());
    const Eigen::VectorXd at_rest = ways_at_rest(rig, body);
    made.motion.time_step_s = sampling.time_step_s;
    made.motion.steps_per_frame = steps_per_frame(sampling);
    constexpr double slack_s = 1e-6;  // times given in decimal are not refused for their last digit
    const int frames = frames_after_the_first(sampling, animation.end_s - animation.start_s, slack_s, rig.file);
    for (int step = 0; step <= frames * made.motion.steps_per_frame; ++step) {
        const double time_s = animation.start_s + sampling.start_s + step * sampling.time_step_s;
        const std::vector<Eigen::Affine3d> transforms = node_transforms(rig, &animation, time_s);
        made.motion.steps.push_back(rigid_pose(body, transforms, &made.stretch));
        if (step % made.motion.steps_per_frame == 0)
            add_frame(ways_from_parents(rig, body, transforms), at_rest, step / made.motion.steps_per_frame,
                      made.distances);
    }
    return made;
}

Positions artist_frame(const Rig& rig, const RiggedBody& body, const RigAnimation& animation,
                       const MotionSampling& sampling, int frame)
{
    const double time_s =
        animation.start_s + sampling.start_s + frame * steps_per_frame(sampling) * sampling.time_step_s;
    return artist_points(body, node_transforms(rig, &animation, time_s), &animation, time_s);
}

}  // namespace pbs
