// The largest possible distance between two evaluations of one projection that round differently (a fused a * b + c
// rounds once; a reciprocal is taken before or after a product): the distance that one step adds, and the factor by
// which it amplifies a difference in its input. Derivation, with eps the spacing of numbers at 1. Stretch: s p12 goes
// through some ten roundings of terms no larger than w k / (w1 + w2) (l + d), volume: some sixteen of terms no larger
// than w k n L^3 / D, where n = 6 |g|, D = sum w n^2, L the longest edge; the cross products of flat tets cancel, which
// magnifies their rounding by L^2 sqrt(sum w / D). Positions are rounded once: eps |p|.
#pragma once

#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/stretch.hpp"
#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace test_support {

struct RoundingBound {
    double step = 0.0;    // [m]
    double growth = 1.0;  // factor for a difference in the input
};

template <typename Scalar>
double largest_coordinate(std::initializer_list<pbs::Vector3<Scalar>> points)
{
    double largest = 0.0;
    for (const auto& point : points) largest = std::max<double>(largest, point.cwiseAbs().maxCoeff());
    return largest;
}

template <typename Scalar>
RoundingBound rounding_of(const pbs::BindConstraint<Scalar>& c, const pbs::Vector3<Scalar>& q,
                          const pbs::Vector3<Scalar>& p)
{
    const double eps = std::numeric_limits<Scalar>::epsilon(), distance = (p - q).norm();
    const double growth = distance > 0.0 ? 1.0 + c.stiffness * (1.0 + c.rest_distance / distance) : 1.0;
    return {eps * (largest_coordinate<Scalar>({p, q}) + 10.0 * c.stiffness * (distance + c.rest_distance)), growth};
}

template <typename Scalar>
RoundingBound rounding_of(const pbs::StretchConstraint<Scalar>& c, Scalar w1, Scalar w2, const pbs::Vector3<Scalar>& p1,
                          const pbs::Vector3<Scalar>& p2)
{
    const double eps = std::numeric_limits<Scalar>::epsilon(), length = (p1 - p2).norm(), w = w1 + w2;
    const double share = w > 0.0 ? c.stiffness * std::max(w1, w2) / w : 0.0;
    const double growth = length > 0.0 ? 1.0 + 2.0 * share * (1.0 + c.rest_length / length) : 1.0;
    return {eps * (largest_coordinate<Scalar>({p1, p2}) + 10.0 * share * (length + c.rest_length)), growth};
}

template <typename Scalar>
RoundingBound rounding_of(const pbs::VolumeConstraint<Scalar>& c, const std::array<Scalar, 4>& w,
                          const std::array<pbs::Vector3<Scalar>, 4>& p)
{
    const double eps = std::numeric_limits<Scalar>::epsilon();
    std::array<pbs::Vec3, 4> x, n;
    for (int i = 0; i < 4; ++i) x[i] = p[i].template cast<double>();
    const pbs::Vec3 p21 = x[1] - x[0], p31 = x[2] - x[0], p41 = x[3] - x[0];
    n = {pbs::Vec3::Zero(), p31.cross(p41), p41.cross(p21), p21.cross(p31)};
    n[0] = -(n[1] + n[2] + n[3]);
    double D = 0.0, w_sum = 0.0, w_n = 0.0, n_largest = 0.0, L = 0.0;
    for (int i = 0; i < 4; ++i) {
        D += w[i] * n[i].squaredNorm();
        w_sum += w[i];
        w_n = std::max(w_n, w[i] * n[i].norm());
        n_largest = std::max(n_largest, n[i].norm());
        for (int j = 0; j < i; ++j) L = std::max(L, (x[i] - x[j]).norm());
    }
    const double P = largest_coordinate<Scalar>({p[0], p[1], p[2], p[3]});
    if (!(D > 0.0)) return {eps * P, 1.0};
    const double six_C = p21.cross(p31).dot(p41) - 6.0 * c.rest_volume, moved = c.stiffness * w_n / D;
    // in 1 / m: one L of L^2 sqrt(sum w / D) is part of the step itself
    const double cancellation = L * std::sqrt(w_sum / D);
    return {eps * (P + 16.0 * moved * (L * L * L + 6.0 * c.rest_volume + std::abs(six_C) * L * cancellation)),
            1.0 + 4.0 * moved * (n_largest + 3.0 * std::abs(six_C) * cancellation)};
}

}  // namespace test_support
