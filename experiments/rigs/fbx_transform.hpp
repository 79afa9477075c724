// How FBX places a node (a "Model" of the file), and how its curves move it. Source: the documentation of Autodesk's
// FBX kit, chapter "Computing transformation matrices" (the formula) and class FbxAnimCurveDef (the curves); for Rrs,
// Maya's segment scale compensation.
//   const FbxPlacement hand = placed_below(elbow, transform_at(node.fbx, tracks, 0.5));
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <vector>

namespace pbs {

// How a node inherits the rotations R, r and scales S, s of its parent and itself: RrSs = R r S s, RSrs = R S r s, and
// Rrs = R s' r s, where s' is the parent's scale without the parent's own Lcl Scaling.
enum class FbxInheritance { RrSs, RSrs, Rrs };

// The properties of a Model by their names in the file. Lengths are in the file's unit, angles in degrees.
struct FbxTransform {
    std::array<Vec3, 3> lcl = {Vec3::Zero(), Vec3::Zero(), Vec3::Ones()};  // Lcl Translation, Lcl Rotation, Lcl Scaling
    Vec3 rotation_offset = Vec3::Zero(), rotation_pivot = Vec3::Zero(), scaling_offset = Vec3::Zero(),
         scaling_pivot = Vec3::Zero();
    Vec3 pre_rotation_deg = Vec3::Zero(), post_rotation_deg = Vec3::Zero();
    int rotation_order = 0;  // of Lcl Rotation: xyz, xzy, yzx, yxz, zxy, zyx, whose first axis turns first
    FbxInheritance inheritance = FbxInheritance::RSrs;
};

// A node in the scene. The rotation alone and the own scale are kept since a child's inheritance may treat them apart.
struct FbxPlacement {
    Eigen::Affine3d world = Eigen::Affine3d::Identity();  // from the node to the scene, in the file's unit
    // the product of the rotations of the node and all above it
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Vec3 own_scale = Vec3::Ones();  // the node's own Lcl Scaling
};

// The node's transform in its parent without inheritance: T Roff Rp Rpre R Rpost^-1 Rp^-1 Soff Sp S Sp^-1.
// Its place is the parent's transform of that place; its axes are combined by the inheritance.
FbxPlacement placed_below(const FbxPlacement& parent, const FbxTransform& node);

// Euler angles [degrees] as a rotation; order as in FbxTransform.
Eigen::Matrix3d euler_rotation(const Vec3& degrees, int order);

// How a curve runs from a key to the next one.
enum class FbxInterpolation { constant, constant_next, linear, cubic };

struct FbxKey {
    double time_s = 0.0, value = 0.0;
    FbxInterpolation interpolation = FbxInterpolation::linear;  // up to the next key
    double slope = 0.0, next_slope = 0.0;  // cubic: behind this key and before the next one [value/s]
    double weight = 1.0 / 3.0,
           next_weight = 1.0 / 3.0;  // cubic: of the two tangents, as parts of the time between the keys
};

// Times that do not go back, 1 key or more.
using FbxCurve = std::vector<FbxKey>;

// The value at a time: that of the first key before it, and of the last one after it. A cubic piece is a Bezier curve
// in time and value.
double value_at(const FbxCurve& curve, double time_s);

// The curves of a node, by property (as FbxTransform::lcl) and axis. An axis without a curve keeps its value.
using FbxTracks = std::array<std::array<std::optional<FbxCurve>, 3>, 3>;

FbxTransform transform_at(FbxTransform node, const FbxTracks& tracks, double time_s);

}  // namespace pbs
