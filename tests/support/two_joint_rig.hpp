// A rig whose poses can be computed by hand: a root joint at (1, 0, 0), an elbow at (1, 2, 0) and a mesh of four
// points. Its animation turns the elbow half round about z within 1 s.
#pragma once

#include "experiments/rigs/rig.hpp"

namespace test_support {

inline pbs::RigNode rig_node(const std::string& name, int parent, const pbs::Vec3& translation)
{
    pbs::RigNode node{name, parent, {}};
    node.rest.translation = translation;
    return node;
}

inline pbs::SkinJoint joint_bound_at(int node, const pbs::Vec3& place)
{
    return {node, Eigen::Affine3d(Eigen::Translation3d(-place))};
}

// Every point follows one joint; `bone` is an index into the joints of the mesh.
inline pbs::Weights one_joint_each(const std::vector<int>& bone)
{
    pbs::Weights skin;
    for (int p = 0; p <= static_cast<int>(bone.size()); ++p) skin.first.push_back(p);
    skin.bone = bone;
    skin.weight.assign(bone.size(), 1.0);
    return skin;
}

inline pbs::Rig two_joint_rig()
{
    pbs::Rig rig;
    rig.file = "arm.gltf";
    rig.nodes = {rig_node("root", -1, {1, 0, 0}), rig_node("elbow", 0, {0, 2, 0}), rig_node("body", -1, {0, 0, 0})};
    pbs::RigMesh mesh;
    mesh.name = "arm";
    mesh.node = 2;
    mesh.points = pbs::Positions{{1, 0, 0}, {1, 2, 0}, {1, 4, 0}, {2, 2, 0}};
    mesh.triangles = pbs::Triangles{{0, 1, 3}, {1, 2, 3}};
    mesh.joints = {joint_bound_at(0, {1, 0, 0}), joint_bound_at(1, {1, 2, 0})};
    mesh.skin = {.first = {0, 1, 3, 4, 6}, .bone = {0, 0, 1, 1, 0, 1}, .weight = {1.0, 0.5, 0.5, 1.0, 0.25, 0.75}};
    rig.meshes = {mesh};
    const pbs::KeyTrack turn{.times_s = {0.0, 1.0}, .values = {{0, 0, 0, 1}, {0, 0, 1, 0}}};
    rig.animations = {{"Bend", 0.0, 1.0, {{1, {}, turn, {}}}}};
    return rig;
}

}  // namespace test_support
