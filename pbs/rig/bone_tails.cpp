#include "pbs/rig/bone_tails.hpp"

#include "pbs/rig/rig_pose.hpp"

#include <algorithm>
#include <numeric>

namespace pbs {
namespace {

constexpr double same_place = 1e-3;        // of the skeleton's extent: nearer joints do not define a direction
constexpr double least_agreement = 0.5;    // of the mean distance of the joints below: a middle nearer than that is no direction
constexpr double share_to_farthest = 0.9;  // a bone without a joint below ends inside the flesh
constexpr double share_of_parent = 0.3;    // the length of a bone whose points say nothing about it

// A joint below a bone, and the weight of all that moves with it.
struct JointBelow {
    Vec3 place;
    double weight = 0.0;
};

class Tails {
public:
    Tails(const Rig& rig, RiggedBody& body) : rig_(rig), body_(body)
    {
        const std::vector<Eigen::Affine3d> rest = node_transforms(rig, nullptr, 0.0);
        place_ = bind_places(rest);
        extent_m_ = (body.surface.colwise().maxCoeff() - body.surface.colwise().minCoeff()).norm();
        add_weights();
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

    // Children come after their parents, so that one pass from the end sums the subtrees.
    void add_weights()
    {
        weight_.assign(rig_.nodes.size(), 0.0);
        has_mesh_.assign(rig_.nodes.size(), false);
        for (const RigMesh& mesh : rig_.meshes) has_mesh_[mesh.node] = true;
        for (std::size_t e = 0; e < body_.skin.bone.size(); ++e) weight_[body_.node[body_.skin.bone[e]]] += body_.skin.weight[e];
        for (std::size_t n = rig_.nodes.size(); n-- > 0;)
            if (const int parent = rig_.nodes[n].parent; parent >= 0) weight_[parent] += weight_[n];
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
        return std::max_element(below.begin(), below.end(), [](const JointBelow& a, const JointBelow& b) { return a.weight < b.weight; })
            ->place;
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
        return bone.head + (farthest_m > same_place * extent_m_ ? share_to_farthest * farthest_m : share_of_parent * parent_m) * along;
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

}  // namespace

void set_tails(const Rig& rig, RiggedBody& body)
{
    Tails(rig, body).set();
}

}  // namespace pbs
