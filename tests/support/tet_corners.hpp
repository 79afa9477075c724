// The four corners of one tet, and a volume constraint's functions on them.
#pragma once

#include "pbs/constraints/volume.hpp"
#include "tests/support/random_points.hpp"

#include <array>

namespace test_support {

template <typename Scalar>
using Corners = std::array<pbs::Vector3<Scalar>, 4>;

template <typename Scalar>
using CornerMasses = std::array<Scalar, 4>;  // inverse masses

// A unit corner with every point moved by up to `noise` of its size; without noise, its rest volume is 1 / 6.
inline Corners<double> noisy_corner(RandomPoints& random, double noise)
{
    Corners<double> p = {pbs::Vec3(0, 0, 0), pbs::Vec3(1, 0, 0), pbs::Vec3(0, 1, 0), pbs::Vec3(0, 0, 1)};
    for (pbs::Vec3& corner : p) corner += random.point(noise);
    return p;
}

template <typename Scalar>
Scalar value_at(const pbs::VolumeConstraint<Scalar>& constraint, const Corners<Scalar>& p)
{
    return value(constraint, p[0], p[1], p[2], p[3]);
}

template <typename Scalar>
Corners<Scalar> gradient_at(const pbs::VolumeConstraint<Scalar>& constraint, const Corners<Scalar>& p)
{
    return gradient(constraint, p[0], p[1], p[2], p[3]);
}

template <typename Scalar>
Corners<Scalar> projected(const pbs::VolumeConstraint<Scalar>& constraint, const CornerMasses<Scalar>& w,
                          Corners<Scalar> p)
{
    project(constraint, w[0], w[1], w[2], w[3], p[0], p[1], p[2], p[3]);
    return p;
}

// Points as one vector, and the corners of a tet from one of 12.
Eigen::VectorXd stacked(const auto& points)
{
    return Eigen::VectorXd::Map(points.front().data(), 3 * static_cast<Eigen::Index>(points.size()));
}
inline Corners<double> unstacked(const Eigen::VectorXd& x)
{
    return {x.segment<3>(0), x.segment<3>(3), x.segment<3>(6), x.segment<3>(9)};
}

}  // namespace test_support
