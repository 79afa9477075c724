// The depth constraint of self-contact: the skin vertex v lies in the tet (1, 2, 3, 4) of another part of the body, and
//   C(x) = m . (x_v - sum beta_i x_i) - delta >= 0
// pushes it out. The tet's deformation F takes the rest point X* = sum beta_i X_i to v; delta is the depth of X* below
// the rest skin, n the direction to the nearest point of that skin, and m = F^-T n. So -C is, to first order, the depth
// of v's own rest point in the tet, whose gradients are -m and beta_i m. beta, m and delta are kept from one detection
// to the next, which makes C linear.
//   project(constraint, {1, 1, 1, 1, 1}, {&x_v, &x_1, &x_2, &x_3, &x_4});
// The five gradients add up to zero, so that a projection conserves linear momentum. The depth at rest needs no normals
// of a folded skin. The paper leaves self-collision to future work (Sec. 5). Its first author published a method with
// spatial hashing: N. Abu Rumman, M. Schaerf, D. Bechmann, Collision Detection for Articulated Deformable Characters,
// 2015. This constraint is another one; it is made for blended shapes, which overlap from the start.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <array>

namespace pbs {

// Scalar: float or double.
template <typename Scalar>
struct DepthConstraint {
    // v, then the corners of the tet; value, gradient and project take positions and do not read them
    std::array<int, 5> vertex;
    std::array<Scalar, 5> weight;  // 1, -beta_1 .. -beta_4
    Vector3<Scalar> m;             // without a unit; of length 1 where the tet is not strained
    Scalar depth;                  // delta, at rest [m]
};

// C [m].
template <typename Scalar>
Scalar value(const DepthConstraint<Scalar>& constraint, const std::array<Vector3<Scalar>, 5>& x)
{
    Vector3<Scalar> offset = constraint.weight[0] * x[0];
    for (int i = 1; i < 5; ++i) offset += constraint.weight[i] * x[i];
    return constraint.m.dot(offset) - constraint.depth;
}

// grad_v C, grad_1 C .. grad_4 C.
template <typename Scalar>
std::array<Vector3<Scalar>, 5> gradient(const DepthConstraint<Scalar>& constraint)
{
    std::array<Vector3<Scalar>, 5> gradients;
    for (int i = 0; i < 5; ++i) gradients[i] = constraint.weight[i] * constraint.m;
    return gradients;
}

// Moves the five points [m] to C = 0 where C < 0, with the multiplier lambda = -C / (|m|^2 (w_v + sum beta_i^2 w_i)).
// w: inverse masses in any common unit; zero is pinned, and nothing moves where all are.
template <typename Scalar>
void project(const DepthConstraint<Scalar>& constraint, const std::array<Scalar, 5>& w,
             std::array<Vector3<Scalar>, 5>& x)
{
    const Scalar C = value(constraint, x);
    Scalar denominator = Scalar(0);
    for (int i = 0; i < 5; ++i) denominator += w[i] * constraint.weight[i] * constraint.weight[i];
    denominator *= constraint.m.squaredNorm();
    if (!(C < Scalar(0) && denominator > Scalar(0))) return;
    const Scalar lambda = -C / denominator;
    for (int i = 0; i < 5; ++i) x[i] += w[i] * lambda * constraint.weight[i] * constraint.m;
}

}  // namespace pbs
