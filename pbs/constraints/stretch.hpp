// The stretch constraint of an edge, Sec. 3.4:  C(p1, p2) = |p1 - p2| - d.
//   project(StretchConstraint<double>{{0, 1}, rest_length, 0.2}, 1.0, 1.0, p1, p2);
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <array>

namespace pbs {

// Scalar: float or double.
template <typename Scalar>
struct StretchConstraint {
    std::array<int, 2> vertex;  // the edge's ends; value, gradient and project take positions and do not read them
    Scalar rest_length;         // d [m]
    Scalar stiffness;           // k_stretch, in [0, 1]
};

// C [m], Eq. 10.
template <typename Scalar>
Scalar value(const StretchConstraint<Scalar>& constraint, const Vector3<Scalar>& p1, const Vector3<Scalar>& p2)
{
    return (p1 - p2).norm() - constraint.rest_length;
}

// grad_p1 C, grad_p2 C; zero where the points coincide, because no direction is better than another there.
template <typename Scalar>
std::array<Vector3<Scalar>, 2> gradient(const StretchConstraint<Scalar>&, const Vector3<Scalar>& p1,
                                        const Vector3<Scalar>& p2)
{
    const Scalar length = (p1 - p2).norm();
    if (!(length > Scalar(0))) return {Vector3<Scalar>::Zero(), Vector3<Scalar>::Zero()};
    const Vector3<Scalar> direction = (p1 - p2) / length;
    return {direction, -direction};
}

// Moves both points [m] by the share k of what removes C. w1, w2: inverse masses, in any common unit; zero is pinned.
// Eq. 8-9 hold for m_i = 1; with unequal masses each gradient is weighted by w_i, so that Eq. 3-4 still do.
template <typename Scalar>
void project(const StretchConstraint<Scalar>& constraint, Scalar w1, Scalar w2, Vector3<Scalar>& p1,
             Vector3<Scalar>& p2)
{
    const Vector3<Scalar> p12 = p1 - p2;
    const Scalar length = p12.norm();
    const Scalar C = length - constraint.rest_length;  // Eq. 10
    const Scalar denominator = (w1 + w2) * length;     // gradients are +-p12 / length, so sum w |g|^2 = w1 + w2
    if (!(denominator > Scalar(0))) return;
    const Vector3<Scalar> k_s_g1 = constraint.stiffness * C / denominator * p12;  // s of Eq. 9
    p1 -= w1 * k_s_g1;                                                            // Eq. 8
    p2 += w2 * k_s_g1;
}

}  // namespace pbs
