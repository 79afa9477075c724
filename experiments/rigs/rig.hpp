// A rig as its file defines it (glTF 2.0, FBX, COLLADA): a tree of nodes, meshes with skin weights and inverse bind
// matrices, animations.
//   const Rig rig = read_rig("hero.glb");                       // rig_reader.hpp
//   const auto nodes = node_transforms(rig, nullptr, 0.0);      // rigged_body.hpp
#pragma once

#include "experiments/rigs/fbx_transform.hpp"
#include "pbs/skinning/weights.hpp"

#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace pbs {

// The transform of a node in its parent: translation * rotation * scale, or a matrix, which no animation may change.
struct NodeTransform {
    Vec3 translation = Vec3::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Vec3 scale = Vec3::Ones();
    std::optional<Eigen::Affine3d> matrix;

    Eigen::Affine3d affine() const;
};

// Names need not be unique, and may be empty.
struct RigNode {
    std::string name;
    int parent = -1;                       // index into Rig::nodes, -1 for a root; parents precede their children
    NodeTransform rest;                    // where no animation says otherwise
    std::optional<FbxTransform> fbx = {};  // in place of `rest`: a node of an FBX file
    std::string body_part = {};            // as the file's own table calls it (VRM: leftUpperArm); empty: it is in none
};

// How a property changes between two keys (glTF 2.0, Appendix C).
enum class Interpolation { step, linear, cubic_spline };

// The keys of one property of one node.
struct KeyTrack {
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times_s;  // they never go back, #keys, 1 or more
    // a vector and 0, or a quaternion x, y, z, w, #keys; cubic_spline: in-tangent, value and
    std::vector<Eigen::Vector4d> values;
    // out-tangent of each key, 3 #keys
};

// A property without keys keeps the value that it has at rest.
struct NodeTracks {
    int node = -1;
    std::optional<KeyTrack> translation = {}, rotation = {}, scale = {};
    FbxTracks fbx = {};  // in place of them: of a node of an FBX file
    // of each morph target of the node's mesh: the first number of each value; empty: none moves
    std::vector<KeyTrack> morph_weights = {};
};

struct RigAnimation {
    std::string name;                   // of a rig that was read, each once
    double start_s = 0.0, end_s = 0.0;  // of its keys
    std::vector<NodeTracks> nodes;      // each node once
};

// A joint of a skin. inverse_bind: from the mesh's coordinates to the frame of the joint, in the pose in which the mesh
// was bound.
struct SkinJoint {
    int node = -1;
    Eigen::Affine3d inverse_bind = Eigen::Affine3d::Identity();
};

// What a surface looks like, in glTF's terms.
struct RigLook {
    // Of each point its normal, zero where the file has none, and its sets of texture coordinates, #P x (3 + 2 #sets)
    // or empty.
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> numbers;
    std::vector<int> material;  // of each triangle in the order of the file's materials, -1: none; #F or empty

    // Makes room for them where there is none yet; column: 0 or 3 + 2 set.
    void put(Eigen::Index first_point, Eigen::Index column, const decltype(numbers)& rows);
    // before whose own there are so many
    void append(const RigLook& other, Eigen::Index points, Eigen::Index triangles);
};

// The materials of a rig's file.
struct RigMaterials {
    std::string document;  // JSON: materials, textures, samplers, extensionsUsed, images; empty: there are none
    std::vector<std::string> images = {};   // the bytes of each image of the document
    std::vector<std::string> remarks = {};  // what the file has and this lacks
};

// The morph targets of a mesh, of which an animation moves the weights. Each adds its displacements times its weight to
// the mesh's points before the joints move them (glTF 2.0, Sec. 3.7.2.2).
struct RigMorphs {
    std::vector<Positions> displacements;  // of each target, #P x 3
    std::vector<double> rest_weights;      // which are contained in the mesh's points, #targets
};

// A mesh of a node with all its primitives. Points are those of the bind pose, in the mesh's own coordinates and the
// file's unit.
struct RigMesh {
    std::string name;
    int node = -1;
    Positions points;               // #P x 3
    Triangles triangles;            // #F x 3
    std::vector<SkinJoint> joints;  // of its skin, weighted or not; empty: it is moved by its node
    Weights skin;  // of the points; `bone` is an index into `joints`; not read where there are no joints
    RigLook look = {};
    RigMorphs morphs = {};  // empty unless an animation moves them
    // how far each point is moved by dual quaternions instead of linear blending, 0 to 1,
    std::vector<double> dual_quaternion_share = {};
    // #P; empty: linear blending
};

// Whether an animation moves more than morph targets.
bool moves_nodes(const RigAnimation& animation);

struct Rig {
    std::string file;
    double unit_m = 1.0;  // metres per unit of the file
    std::vector<RigNode> nodes;
    std::vector<RigMesh> meshes;
    std::vector<RigAnimation> animations;
    std::vector<std::string> remarks;  // what the reader left out
    std::vector<std::string> notes;    // what it put right by the format's rules, so that nothing is missing
};

// The animation of this name; the first one where the name is empty, null where the file has none. An InputError lists
// the names.
const RigAnimation* find_animation(const Rig& rig, const std::string& name);

}  // namespace pbs
