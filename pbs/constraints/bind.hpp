// The bind constraint of a vertex to its nearest bone, Sec. 3.6: a stretch constraint to its projection q on that bone,
//   C(p) = |p - q| - d,
// where q is a material point of the bone, moves with it and has infinite mass: the bone takes the reaction, so momentum is not conserved.
//   project(BindConstraint<double>{7, rest_distance, 1.0}, posed_bind_point, particle);
// A vertex on the bone (d = 0) is drawn to its material point by the same formula: k = 1 puts it there.
#pragma once

#include "pbs/constraints/particle.hpp"

#include <Eigen/Geometry>

namespace pbs {

template <typename Scalar>
struct BindConstraint {
    int vertex;
    Scalar rest_distance;  // d [m]
    Scalar stiffness;      // k_bind, in [0, 1]
};

// C [m].
template <typename Scalar>
Scalar value(const BindConstraint<Scalar>& constraint, const Vector3<Scalar>& p, const Vector3<Scalar>& q)
{
    return (p - q).norm() - constraint.rest_distance;
}

// grad_p C; zero where p and q coincide, because no direction is better than another there.
template <typename Scalar>
Vector3<Scalar> gradient(const BindConstraint<Scalar>&, const Vector3<Scalar>& p, const Vector3<Scalar>& q)
{
    const Scalar distance = (p - q).norm();
    if (!(distance > Scalar(0))) return Vector3<Scalar>::Zero();
    return (p - q) / distance;
}

// Moves the point by the share k of what removes C; a pinned one (1 / m = 0) stays.
template <typename Scalar>
void project(const BindConstraint<Scalar>& constraint, const Vector3<Scalar>& q, Particle<Scalar>& particle)
{
    const Scalar w = particle.inverse_mass;
    const Scalar C = value(constraint, particle.position, q);
    const Vector3<Scalar> g = gradient(constraint, particle.position, q);
    const Scalar denominator = w * g.squaredNorm();  // the bone's share is zero
    if (!(denominator > Scalar(0))) return;
    const Scalar s = C / denominator;                       // Eq. 9
    particle.position -= s * constraint.stiffness * w * g;  // Eq. 8
}

}  // namespace pbs
