// The volume constraint of a tet, Sec. 3.5:  C(p1, p2, p3, p4) = (p21 x p31) . p41 / 6 - V0, with pij = pi - pj.
//   project(VolumeConstraint<double>{{0, 1, 2, 3}, rest_volume, 1.0}, particle_1, particle_2, particle_3, particle_4);
// The volume is signed: an inverted tet is in error by more than its rest volume and is pushed back through flat.
#pragma once

#include "pbs/constraints/particle.hpp"

#include <Eigen/Geometry>

#include <array>

namespace pbs {

template <typename Scalar>
struct VolumeConstraint {
    std::array<int, 4> vertex;
    Scalar rest_volume;  // V0 [m^3]
    Scalar stiffness;    // k_volume, in [0, 1]
};

// C [m^3], Eq. 11.
template <typename Scalar>
Scalar value(const VolumeConstraint<Scalar>& constraint, const Vector3<Scalar>& p1, const Vector3<Scalar>& p2, const Vector3<Scalar>& p3,
             const Vector3<Scalar>& p4)
{
    const Vector3<Scalar> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    return p21.cross(p31).dot(p41) / Scalar(6) - constraint.rest_volume;
}

// grad_p1 C .. grad_p4 C [m^2], derived from Eq. 11. Eq. 12-14 print them under the wrong particles and with absolute positions
// (volume_printed.hpp has those).
template <typename Scalar>
std::array<Vector3<Scalar>, 4> gradient(const VolumeConstraint<Scalar>&, const Vector3<Scalar>& p1, const Vector3<Scalar>& p2,
                                        const Vector3<Scalar>& p3, const Vector3<Scalar>& p4)
{
    const Vector3<Scalar> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    const Vector3<Scalar> g2 = p31.cross(p41) / Scalar(6);
    const Vector3<Scalar> g3 = p41.cross(p21) / Scalar(6);
    const Vector3<Scalar> g4 = p21.cross(p31) / Scalar(6);
    return {-(g2 + g3 + g4), g2, g3, g4};  // the first by Eq. 15
}

// Moves the four corners by the share k of what removes the linearised C (what is left is of second order). Eq. 8-9 hold for m_i = 1;
// with unequal masses each gradient is weighted by 1 / m_i, so that Eq. 3-4 still do. A tet collapsed to a line or point has no gradient
// and stays. Eq. 17-20 are printed with the opposite sign.
template <typename Scalar>
void project(const VolumeConstraint<Scalar>& constraint, Particle<Scalar>& particle_1, Particle<Scalar>& particle_2,
             Particle<Scalar>& particle_3, Particle<Scalar>& particle_4)
{
    const Vector3<Scalar>&p1 = particle_1.position, &p2 = particle_2.position, &p3 = particle_3.position, &p4 = particle_4.position;
    const Scalar w1 = particle_1.inverse_mass, w2 = particle_2.inverse_mass, w3 = particle_3.inverse_mass, w4 = particle_4.inverse_mass;
    const Scalar C = value(constraint, p1, p2, p3, p4);                  // Eq. 11
    const auto [g1, g2, g3, g4] = gradient(constraint, p1, p2, p3, p4);  // of Eq. 11
    const Scalar denominator = w1 * g1.squaredNorm() + w2 * g2.squaredNorm() + w3 * g3.squaredNorm() + w4 * g4.squaredNorm();
    if (!(denominator > Scalar(0))) return;
    const Scalar s = C / denominator;                           // Eq. 21
    particle_1.position -= s * constraint.stiffness * w1 * g1;  // Eq. 8
    particle_2.position -= s * constraint.stiffness * w2 * g2;
    particle_3.position -= s * constraint.stiffness * w3 * g3;
    particle_4.position -= s * constraint.stiffness * w4 * g4;
}

}  // namespace pbs
