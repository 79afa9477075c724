// Reference: the depth of the rest point in a block whose skin is flat, by hand. Tolerances: some thirty roundings of
// numbers of order one.
#include "pbs/contact/depth_constraint.hpp"

#include "tests/support/eps_sweep.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace depth_constraint_tests {
namespace {

using namespace test_support;
using pbs::Vec3;
using Points = std::array<Vec3, 5>;
using Constraint = pbs::DepthConstraint<double>;

const Points rest = {Vec3(5, 5, 5), Vec3(0, 0, -1), Vec3(1, 0, -1.1), Vec3(0, 1, -0.9), Vec3(0.1, 0.2, -0.2)};
const double rounding = rounding_error(30.0, 4.0);

Eigen::Matrix3d edges(const Points& x)
{
    Eigen::Matrix3d edges;
    edges << x[2] - x[1], x[3] - x[1], x[4] - x[1];
    return edges;
}

// X* of the vertex in the tet, whose skin is the plane z = 0: the depth is -z.
Vec3 rest_point(const Points& x)
{
    return rest[1] + edges(rest) * edges(x).inverse() * (x[0] - x[1]);
}

Points deformed(unsigned seed = 4)
{
    RandomPoints random(seed);
    Points x = rest;
    for (int i = 1; i < 5; ++i) x[i] += random.point(0.2);
    x[0] = 0.2 * x[1] + 0.3 * x[2] + 0.1 * x[3] + 0.4 * x[4];
    return x;
}

Constraint constraint_of(const Points& x)
{
    const Eigen::Matrix3d F = edges(x) * edges(rest).inverse();
    return {
        {0, 1, 2, 3, 4}, {1.0, -0.2, -0.3, -0.1, -0.4}, F.transpose().inverse() * Vec3::UnitZ(), -rest_point(x).z()};
}

TEST(DepthConstraint, IsMinusTheDepthWhereItIsMade)
{
    const Points x = deformed();
    EXPECT_GT(constraint_of(x).depth, 0.1);
    EXPECT_NEAR(value(constraint_of(x), x), -constraint_of(x).depth, rounding);
}

TEST(DepthConstraint, GradientIsThatOfTheDepthOfTheVertexInTheDeformingTet)
{
    const Points x = deformed();
    const auto of_C = gradient(constraint_of(x));
    Eigen::VectorXd flat(15), direction(15);
    RandomPoints random(9);
    for (int i = 0; i < 5; ++i) flat.segment<3>(3 * i) = x[i], direction.segment<3>(3 * i) = random.point(1.0);
    double slope = 0.0;
    for (int i = 0; i < 5; ++i) slope += of_C[i].dot(direction.segment<3>(3 * i));
    const auto minus_depth = [](const Eigen::VectorXd& at) {
        Points moved;
        for (int i = 0; i < 5; ++i) moved[i] = at.segment<3>(3 * i);
        return rest_point(moved).z();
    };
    expect_slope_by_eps_sweep(minus_depth, flat, direction, slope, 0.1);
}

TEST(DepthConstraint, ProjectionEndsAtZeroAndConservesMomentum)
{
    const Points before = deformed();
    const Constraint constraint = constraint_of(before);
    for (const std::array<double, 5>& w :
         {std::array{1.0, 1.0, 1.0, 1.0, 1.0}, {0.5, 1.0, 2.0, 4.0, 8.0}, {0.0, 1.0, 1.0, 1.0, 1.0}}) {
        Points x = before;
        project(constraint, w, x);
        EXPECT_NEAR(value(constraint, x), 0.0, rounding);
        Vec3 momentum = Vec3::Zero();
        for (int i = 0; i < 5; ++i) {
            if (w[i] > 0.0) momentum += (x[i] - before[i]) / w[i];
            if (w[i] == 0.0) {
                EXPECT_EQ(x[i], before[i]);
            }
        }
        if (w[0] > 0.0) {
            EXPECT_LE(momentum.norm(), rounding);
        }
    }
}

TEST(DepthConstraint, MovesNothingWhereItHoldsOrAllIsPinned)
{
    Constraint constraint = constraint_of(deformed());
    Points x = deformed();
    project(constraint, {0, 0, 0, 0, 0}, x);
    EXPECT_EQ(x, deformed());
    constraint.depth = -0.1;
    project(constraint, {1, 1, 1, 1, 1}, x);
    EXPECT_EQ(x, deformed());
}

}  // namespace
}  // namespace depth_constraint_tests
