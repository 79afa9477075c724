#include "experiments/characters/skeleton_file.hpp"
#include "pbs/geometry/input_error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <sstream>

namespace pbs {
namespace {

constexpr double shortest_bone = 1e-9;  // of the diagonal of the skeleton's bounding box
constexpr std::size_t most_joints = 2000;

std::map<std::string, int> index_of_names(const std::vector<NamedJoint>& joints, const std::string& file)
{
    std::map<std::string, int> index;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const auto [first, is_new] = index.emplace(joints[j].name, static_cast<int>(j));
        if (!is_new) {
            const std::string other = std::to_string(joints[first->second].line);
            throw InputError(file, joints[j].line, "name", joints[j].name, "already used in line " + other);
        }
    }
    return index;
}

void check_lengths(const std::vector<NamedJoint>& joints, const std::string& file)
{
    Eigen::AlignedBox3d box;
    for (const NamedJoint& joint : joints)
        if (!(joint.head.cwiseAbs().maxCoeff() <= farthest_m && joint.tail.cwiseAbs().maxCoeff() <= farthest_m))
            throw InputError(file, joint.line, joint.name, "", "expected a bone within 1e9 m of the origin");
    for (const NamedJoint& joint : joints) box.extend(joint.head).extend(joint.tail);
    for (const NamedJoint& joint : joints) {
        const double length = (joint.tail - joint.head).norm();
        if (length > shortest_bone * box.diagonal().norm()) continue;
        std::ostringstream value;
        value << "[" << joint.tail.transpose() << "]";
        throw InputError(file, joint.line, joint.name + ".tail_m", value.str(),
                         "a bone needs a length: tail_m differs from head_m");
    }
}

std::vector<int> parents_of(const std::vector<NamedJoint>& joints, const std::string& file)
{
    const std::map<std::string, int> index = index_of_names(joints, file);
    std::vector<int> parent;
    std::vector<std::string> names;
    bool has_root = false;
    for (const NamedJoint& joint : joints) names.push_back(joint.name);
    for (const NamedJoint& joint : joints) {
        has_root = has_root || joint.parent.empty();
        const auto found = index.find(joint.parent);
        if (!joint.parent.empty() && found == index.end())
            throw InputError(file, joint.line, joint.name + ".parent", joint.parent,
                             "no such joint; the nearest is '" + nearest_name(joint.parent, names) + "'");
        parent.push_back(joint.parent.empty() ? -1 : found->second);
    }
    if (!has_root) throw InputError(file, 0, "joint", "", "no root: expected a joint with parent = \"\"");
    return parent;
}

bool is_paired(const FoldedBone& bone)
{
    return bone.name.find('*') != std::string::npos;
}

std::string on_side(std::string name, char side)
{
    std::replace(name.begin(), name.end(), '*', side);
    return name;
}

}  // namespace

Skeleton order_skeleton(const std::vector<NamedJoint>& joints, const std::string& file)
{
    if (joints.empty()) throw InputError(file, 0, "joint", "", "expected at least one [[joint]]");
    if (joints.size() > most_joints)
        throw InputError(file, joints[most_joints].line, "joints", std::to_string(joints.size()),
                         "expected at most " + std::to_string(most_joints));
    check_lengths(joints, file);
    const std::vector<int> parent = parents_of(joints, file);

    Skeleton skeleton;
    std::vector<int> place(joints.size(), -1);
    for (bool grown = true; grown;) {
        grown = false;
        for (std::size_t j = 0; j < joints.size(); ++j) {
            if (place[j] >= 0 || (parent[j] >= 0 && place[parent[j]] < 0)) continue;
            place[j] = static_cast<int>(skeleton.bones.size());
            skeleton.bones.push_back(
                {joints[j].name, parent[j] < 0 ? -1 : place[parent[j]], joints[j].head, joints[j].tail});
            grown = true;
        }
    }
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (place[j] < 0)
            throw InputError(file, joints[j].line, joints[j].name + ".parent", joints[j].parent,
                             "its parents form a cycle");
    return skeleton;
}

Skeleton fold_skeleton(const std::vector<FoldedBone>& bones, const std::string& file,
                       const std::function<Vec3(const std::string& point)>& point_named)
{
    std::vector<NamedJoint> joints;
    for (const char side : {'*', 'L', 'R'})
        for (const FoldedBone& bone : bones) {
            if (is_paired(bone) == (side == '*')) continue;
            const auto mean = [&](const std::vector<std::string>& points) -> Vec3 {
                Vec3 sum = Vec3::Zero();
                for (const std::string& point : points) sum += point_named(on_side(point, side));
                return sum / static_cast<double>(points.size());
            };
            joints.push_back({on_side(bone.name, side), on_side(bone.parent, side), mean(bone.head), mean(bone.tail)});
        }
    return order_skeleton(joints, file);
}

}  // namespace pbs
