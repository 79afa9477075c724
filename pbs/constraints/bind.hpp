// The bind constraint of a vertex to its nearest bone, Sec. 3.6: a stretch constraint to its projection q on that bone,
//   C(p) = |p - q| - d,
// where q is a material point of the bone, moves with it and has infinite mass: the bone takes the reaction, so
// momentum is not conserved.
//   project(BindConstraint<double>{7, rest_distance, 1.0}, 1.0, q, p);
// A vertex on the bone (d = 0) is drawn to its material point by the same formula: k = 1 puts it there.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

namespace pbs {

// Scalar: float or double.
template <typename Scalar>
struct BindConstraint {
    int vertex;            // its number in the mesh; value, gradient and project take positions and do not read it
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

// Moves the point [m] by the share k of what removes C; the bone has no inverse mass. A pinned point (w = 0) stays, any
// other moves alike.
template <typename Scalar>
void project(const BindConstraint<Scalar>& constraint, Scalar w, const Vector3<Scalar>& q, Vector3<Scalar>& p)
{
    const Vector3<Scalar> from_q = p - q;
    const Scalar distance = from_q.norm();
    const Scalar C = distance - constraint.rest_distance;
    if (!(w * distance > Scalar(0))) return;
    p -= constraint.stiffness * C / distance * from_q;  // Eq. 8-9: the gradient is from_q / distance, and w cancels
}

}  // namespace pbs
