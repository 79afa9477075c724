// The stretch constraint of an edge, Sec. 3.4:  C(p1, p2) = |p1 - p2| - d.
//   project(StretchConstraint<double>{{0, 1}, rest_length, 0.2}, particle_1, particle_2);
#pragma once

#include "pbs/constraints/particle.hpp"

#include <Eigen/Geometry>

#include <array>

namespace pbs {

template <typename Scalar>
struct StretchConstraint {
    std::array<int, 2> vertex;
    Scalar rest_length;  // d [m]
    Scalar stiffness;    // k_stretch, in [0, 1]
};

// C [m], Eq. 10.
template <typename Scalar>
Scalar value(const StretchConstraint<Scalar>& constraint, const Vector3<Scalar>& p1, const Vector3<Scalar>& p2)
{
    return (p1 - p2).norm() - constraint.rest_length;
}

// grad_p1 C, grad_p2 C; zero where the points coincide, because no direction is better than another there.
template <typename Scalar>
std::array<Vector3<Scalar>, 2> gradient(const StretchConstraint<Scalar>&, const Vector3<Scalar>& p1, const Vector3<Scalar>& p2)
{
    const Scalar length = (p1 - p2).norm();
    if (!(length > Scalar(0))) return {Vector3<Scalar>::Zero(), Vector3<Scalar>::Zero()};
    const Vector3<Scalar> direction = (p1 - p2) / length;
    return {direction, -direction};
}

// Moves both points by the share k of what removes C. Eq. 8-9 hold for m_i = 1; with unequal masses each gradient is weighted by 1 / m_i,
// so that Eq. 3-4 still do.
template <typename Scalar>
void project(const StretchConstraint<Scalar>& constraint, Particle<Scalar>& particle_1, Particle<Scalar>& particle_2)
{
    const Scalar w1 = particle_1.inverse_mass, w2 = particle_2.inverse_mass;
    const Scalar C = value(constraint, particle_1.position, particle_2.position);  // Eq. 10
    const auto [g1, g2] = gradient(constraint, particle_1.position, particle_2.position);
    const Scalar denominator = w1 * g1.squaredNorm() + w2 * g2.squaredNorm();
    if (!(denominator > Scalar(0))) return;
    const Scalar s = C / denominator;                           // Eq. 9
    particle_1.position -= s * constraint.stiffness * w1 * g1;  // Eq. 8
    particle_2.position -= s * constraint.stiffness * w2 * g2;
}

}  // namespace pbs
