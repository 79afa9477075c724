// Eq. 12-20 as they stand in print, for the experiment on what that does to the volume; volume.hpp is the form to use.
//   project_printed<Printed::labels_relative>(constraint, p1, p2, p3, p4);
// Under p2 is printed what belongs to p4, under p3 what belongs to p2, under p4 what belongs to p3; the products are of
// absolute positions; and Eq. 17-20 carry the opposite sign of Eq. 8. All for m_i = 1.
#pragma once

#include "pbs/constraints/volume.hpp"

namespace pbs {

// One error at a time, and all of them. labels_relative: Eq. 12-14 under their printed particles, of positions relative
// to p1; labels_absolute: of absolute positions, as printed; both with the sign of Eq. 8. sign: the derived gradients
// with the sign printed in Eq. 17-20. as_printed: labels, absolute positions and sign.
enum class Printed { labels_relative, labels_absolute, sign, as_printed };

// The gradients that Eq. 12-16 print for p1 .. p4 [m^2].
template <Printed form, typename Scalar>
std::array<Vector3<Scalar>, 4> gradient_printed(const VolumeConstraint<Scalar>& constraint, const Vector3<Scalar>& p1,
                                                const Vector3<Scalar>& p2, const Vector3<Scalar>& p3,
                                                const Vector3<Scalar>& p4)
{
    if constexpr (form == Printed::sign) return gradient(constraint, p1, p2, p3, p4);
    const Vector3<Scalar> origin = form == Printed::labels_relative ? p1 : Vector3<Scalar>(Vector3<Scalar>::Zero());
    const Vector3<Scalar> a = p2 - origin, b = p3 - origin, c = p4 - origin;
    const Vector3<Scalar> g2 = a.cross(b) / Scalar(6);  // Eq. 12
    const Vector3<Scalar> g3 = b.cross(c) / Scalar(6);  // Eq. 13
    const Vector3<Scalar> g4 = c.cross(a) / Scalar(6);  // Eq. 14
    return {-(g2 + g3 + g4), g2, g3, g4};               // Eq. 15-16
}

// Eq. 17-21: moves the four corners [m] with the stiffness of the constraint, all masses one. Nothing moves where all
// gradients are zero.
template <Printed form, typename Scalar>
void project_printed(const VolumeConstraint<Scalar>& constraint, Vector3<Scalar>& p1, Vector3<Scalar>& p2,
                     Vector3<Scalar>& p3, Vector3<Scalar>& p4)
{
    const Scalar C = value(constraint, p1, p2, p3, p4);  // Eq. 11
    const auto [g1, g2, g3, g4] = gradient_printed<form>(constraint, p1, p2, p3, p4);
    const Scalar denominator = g1.squaredNorm() + g2.squaredNorm() + g3.squaredNorm() + g4.squaredNorm();
    if (!(denominator > Scalar(0))) return;
    constexpr bool sign_printed = form == Printed::sign || form == Printed::as_printed;
    const Scalar s = C / denominator;  // Eq. 21
    const Scalar k_s = constraint.stiffness * (sign_printed ? s : -s);
    p1 += k_s * g1;  // Eq. 17, its minus is in Eq. 16
    p2 += k_s * g2;  // Eq. 18
    p3 += k_s * g3;  // Eq. 19
    p4 += k_s * g4;  // Eq. 20
}

}  // namespace pbs
