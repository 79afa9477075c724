// The volume constraint of a tet, Sec. 3.5:  C(p1, p2, p3, p4) = (p21 x p31) . p41 / 6 - V0, with pij = pi - pj.
//   project(VolumeConstraint<double>{{0, 1, 2, 3}, rest_volume, 1.0}, 1.0, 1.0, 1.0, 1.0, p1, p2, p3, p4);
// The volume is signed: an inverted tet is in error by more than its rest volume and is pushed back through flat.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>

namespace pbs {

// Scalar: float or double.
template <typename Scalar>
struct VolumeConstraint {
    // p1 .. p4, positively oriented; value, gradient and project take positions and do not read them
    std::array<int, 4> vertex;
    Scalar rest_volume;  // V0 [m^3], positive
    Scalar stiffness;    // k_volume, in [0, 1]
};

// 1 / 6 of Eq. 11.
template <typename Scalar>
inline constexpr Scalar sixth = Scalar(1) / Scalar(6);

// C [m^3], Eq. 11.
template <typename Scalar>
Scalar value(const VolumeConstraint<Scalar>& constraint, const Vector3<Scalar>& p1, const Vector3<Scalar>& p2,
             const Vector3<Scalar>& p3, const Vector3<Scalar>& p4)
{
    const Vector3<Scalar> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    return sixth<Scalar> * p21.cross(p31).dot(p41) - constraint.rest_volume;
}

// grad_p1 C .. grad_p4 C [m^2], derived from Eq. 11. Eq. 12-14 print them under the wrong particles and with absolute
// positions (volume_printed.hpp has those).
template <typename Scalar>
std::array<Vector3<Scalar>, 4> gradient(const VolumeConstraint<Scalar>&, const Vector3<Scalar>& p1,
                                        const Vector3<Scalar>& p2, const Vector3<Scalar>& p3, const Vector3<Scalar>& p4)
{
    const Vector3<Scalar> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    const Vector3<Scalar> g2 = sixth<Scalar> * p31.cross(p41);
    const Vector3<Scalar> g3 = sixth<Scalar> * p41.cross(p21);
    const Vector3<Scalar> g4 = sixth<Scalar> * p21.cross(p31);
    return {-(g2 + g3 + g4), g2, g3, g4};  // the first by Eq. 15
}

// Sum of w |g|^2 below which gradients are the rounding of edges' cross products: the tet is a line or a point.
// longest2: its longest edge at p1, squared. Each component of 6 g is off by some eps |a| |b|, the sum of three by less
// than 4 eps longest2.
template <typename Scalar>
Scalar rounding_of_gradients(Scalar longest2, Scalar sum_of_w)
{
    const Scalar rounding = sixth<Scalar> * 4 * std::numeric_limits<Scalar>::epsilon() * longest2;
    return rounding * rounding * sum_of_w;
}

// Moves the four corners [m] by the share k of what removes the linearised C (what is left is of second order). w1 ..
// w4: inverse masses, in any common unit; zero is pinned. Eq. 8-9 hold for m_i = 1; with unequal masses each gradient
// is weighted by w_i, so that Eq. 3-4 still do. A tet collapsed to a line or point has no gradient and stays. Eq. 17-20
// are printed with the opposite sign.
template <typename Scalar>
void project(const VolumeConstraint<Scalar>& constraint, Scalar w1, Scalar w2, Scalar w3, Scalar w4,
             Vector3<Scalar>& p1, Vector3<Scalar>& p2, Vector3<Scalar>& p3, Vector3<Scalar>& p4)
{
    const Vector3<Scalar> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    const Vector3<Scalar> p21_x_p31 = p21.cross(p31);
    const Scalar C = sixth<Scalar> * p21_x_p31.dot(p41) - constraint.rest_volume;  // Eq. 11
    const Vector3<Scalar> g2 = sixth<Scalar> * p31.cross(p41);
    const Vector3<Scalar> g3 = sixth<Scalar> * p41.cross(p21);
    const Vector3<Scalar> g4 = sixth<Scalar> * p21_x_p31;
    const Vector3<Scalar> g1 = -(g2 + g3 + g4);  // Eq. 15
    const Scalar denominator =
        w1 * g1.squaredNorm() + w2 * g2.squaredNorm() + w3 * g3.squaredNorm() + w4 * g4.squaredNorm();
    const Scalar longest2 = std::max({p21.squaredNorm(), p31.squaredNorm(), p41.squaredNorm()});
    if (!(denominator > rounding_of_gradients(longest2, w1 + w2 + w3 + w4))) return;
    const Scalar k_s = constraint.stiffness * C / denominator;  // s of Eq. 21
    p1 -= k_s * w1 * g1;                                        // Eq. 8
    p2 -= k_s * w2 * g2;
    p3 -= k_s * w3 * g3;
    p4 -= k_s * w4 * g4;
}

}  // namespace pbs
