// The constraints of the code published by the paper's first author (author_solver.hpp): value, gradient, multiplier, correction. All
// masses are one. Each projection departs from the paper's, or from that of pbs/constraints, in what its comment names.
//   project(AuthorVolume{{0, 1, 2, 3}, rest_volume}, stiffness, x);
// x: positions [m], #V.
#pragma once

#include "pbs/constraints/volume.hpp"

#include <algorithm>
#include <vector>

namespace pbs {

// The sum of squared volume gradients [unit^4] below which that code leaves a tet out. It depends on the unit of length.
inline constexpr double smallest_gradient2 = 1e-6;

struct AuthorStiffness {
    double compression, stretch;     // of lengths below their rest length, and of all others
    double volume_inverted, volume;  // of tets with negative volume, and of all others
    double smallest_gradient2_m4;    // smallest_gradient2 in metres
};

struct AuthorVolume {
    std::array<int, 4> vertex;
    double rest_volume;  // V0 [m^3], absolute
};

struct AuthorStretch {
    std::array<int, 2> vertex;
    double rest_length;  // d [m]
};

struct AuthorBind {
    int vertex, bone;
    double distance;  // d_i [m], from the bone at rest
};

// A posed bone [m].
struct BoneSegment {
    Vector3<double> head, tail;
};

inline double length_stiffness(double C, const AuthorStiffness& k)
{
    return C < 0.0 ? k.compression : k.stretch;
}

// The point of a bone nearest to p; the head of a bone without length.
inline Vector3<double> nearest_point(const BoneSegment& bone, const Vector3<double>& p)
{
    const Vector3<double> axis = bone.tail - bone.head;
    const double length2 = axis.squaredNorm();
    if (!(length2 > 0.0)) return bone.head;
    return bone.head + std::clamp((p - bone.head).dot(axis) / length2, 0.0, 1.0) * axis;
}

// C is Eq. 11, but the gradients lack its 1/6. So lambda is a sixth of what Eq. 21 gives with the gradients of Eq. 11, and with k = 1 five
// sixths of C remain to first order.
inline void project(const AuthorVolume& constraint, const AuthorStiffness& k, std::vector<Vector3<double>>& x)
{
    auto &p1 = x[constraint.vertex[0]], &p2 = x[constraint.vertex[1]], &p3 = x[constraint.vertex[2]], &p4 = x[constraint.vertex[3]];
    const Vector3<double> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    const double volume = sixth<double> * p21.cross(p31).dot(p41);
    const double C = volume - constraint.rest_volume;
    const Vector3<double> g2 = p31.cross(p41), g3 = p41.cross(p21), g4 = p21.cross(p31), g1 = -(g2 + g3 + g4);
    const double gradient2 = g1.squaredNorm() + g2.squaredNorm() + g3.squaredNorm() + g4.squaredNorm();
    if (!(gradient2 >= k.smallest_gradient2_m4) || !(gradient2 > 0.0)) return;
    const double lambda = (volume < 0.0 ? k.volume_inverted : k.volume) * C / gradient2;
    p1 -= lambda * g1;
    p2 -= lambda * g2;
    p3 -= lambda * g3;
    p4 -= lambda * g4;
}

// The posed bone is searched for its nearest point in every projection, where the paper has a point that moves with the bone. The
// correction has the factor 1/2, as if the bone were a second free particle. A vertex on its bone has no direction and stays.
inline void project(const AuthorBind& constraint, const std::vector<BoneSegment>& bones, const AuthorStiffness& k,
                    std::vector<Vector3<double>>& x)
{
    Vector3<double>& p = x[constraint.vertex];
    const Vector3<double> to_bone = nearest_point(bones[constraint.bone], p) - p;
    const double length = to_bone.norm();
    if (!(length > 0.0)) return;
    const double C = length - constraint.distance;
    p += 0.5 * length_stiffness(C, k) * C / length * to_bone;
}

// Eq. 8-10 with k by the sign of C. An edge without length has no direction and stays; that code does not test for it.
inline void project(const AuthorStretch& constraint, const AuthorStiffness& k, std::vector<Vector3<double>>& x)
{
    auto &p1 = x[constraint.vertex[0]], &p2 = x[constraint.vertex[1]];
    const Vector3<double> p21 = p2 - p1;
    const double length = p21.norm();
    if (!(length > 0.0)) return;
    const double C = length - constraint.rest_length;
    const Vector3<double> correction = 0.5 * length_stiffness(C, k) * C / length * p21;
    p1 += correction;
    p2 -= correction;
}

}  // namespace pbs
