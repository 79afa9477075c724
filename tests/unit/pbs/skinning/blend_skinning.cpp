// Reference: the rest pose, rigid transforms, and the caller's memory. Tolerances: the roundings of a blend.
#include "pbs/skinning/blend.hpp"

#include "tests/support/scalar_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using pbs::BlendSkinning;
using pbs::Pose;
using pbs::Positions;
using pbs::Vec3;
using pbs::Weights;

template <class Scalar>
class BlendSkinningOf : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BlendSkinningOf, Scalars);

Pose two_bones()
{
    Pose pose(2, Eigen::Isometry3d::Identity());
    pose[0].linear() = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    pose[1].linear() = Eigen::AngleAxisd(-1.1, Vec3(3, -1, 1).normalized()).toRotationMatrix();
    pose[1].translation() = Vec3(0.5, -0.25, 1.0);
    return pose;
}

// One rigid vertex, one blended by its own row, and two with a shared row.
const Weights four_vertices = {{0, 1, 3, 5, 7}, {1, 0, 1, 0, 1, 0, 1}, {1.0, 0.25, 0.75, 0.5, 0.5, 0.5, 0.5}};
const Positions four_points = (Positions(4, 3) << 0.125, 0.5, -0.25, 0.25, -0.5, 1.0, -1.0, 0.0, 0.75, 0.5, 0.5, 0.5).finished();

// Coordinates [m] of these points, which are rounded relative to an origin at that distance. The norm of a point relative to the body's
// middle is at most 1.7, and that of a translation of the middle is at most 2.3. An entry of a matrix is rounded once and blended in two
// roundings for each of two bones; its product with a coordinate and three sums follow, and the reference rounds as often.
template <class Scalar>
double linear_error(double origin = 0.0)
{
    return test_support::rounding_error_in<Scalar>(2 * (1 + 2 * 2 + 1 + 3), 1.7 + 2.3 + origin);
}

// The same for dual quaternions. The five roundings of their entries occur twice in an entry of the matrix, with two of a product and a
// sum, and twice more in |r|^2, with four of its products and sums; |r|^2 >= 1/4 + 1/4 of two bones divides.
template <class Scalar>
double dual_quaternion_error()
{
    return test_support::rounding_error_in<Scalar>(2 * (2 * 5 + 2 + 2 * 5 + 4 + 1 + 1 + 3), 2.0 * (1.7 + 2.3));
}

TYPED_TEST(BlendSkinningOf, RestPoseStaysWhereItIs)
{
    BlendSkinning<TypeParam> skinning(four_points, four_vertices);
    const Pose rest(2, Eigen::Isometry3d::Identity());
    Positions posed;
    skinning.linear(rest, posed);
    EXPECT_EQ(posed, four_points);
    skinning.dual_quaternion(rest, posed);
    EXPECT_EQ(posed, four_points);
}

TYPED_TEST(BlendSkinningOf, VertexOfOneBoneIsTheSameInBothBlends)
{
    BlendSkinning<TypeParam> skinning(four_points, four_vertices);
    Positions lbs, dqs;
    skinning.linear(two_bones(), lbs);
    skinning.dual_quaternion(two_bones(), dqs);
    EXPECT_EQ(lbs.row(0), dqs.row(0));
    const Vec3 expected = two_bones()[1] * Vec3(four_points.row(0));
    EXPECT_LT((lbs.row(0).transpose() - expected).norm(), std::sqrt(3.0) * linear_error<TypeParam>());
}

TYPED_TEST(BlendSkinningOf, RawRowsAreRelativeToTheOriginAndEndWithTheLastVertex)
{
    BlendSkinning<TypeParam> skinning(four_points, four_vertices);
    const Vec3 origin(1.0, 2.0, 3.0);
    const TypeParam untouched = -777;
    std::vector<TypeParam> rows(3 * 4 + 4, untouched);
    Positions posed;
    pbs::linear_blend_skinning(four_points, four_vertices, two_bones(), posed);
    skinning.linear_rows(two_bones(), origin, rows.data());
    for (int i = 0; i < 4; ++i)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(rows[3 * i + axis], posed(i, axis) - origin[axis], linear_error<TypeParam>(origin.norm()));
    for (int i = 12; i < 16; ++i) EXPECT_EQ(rows[i], untouched);
}

TYPED_TEST(BlendSkinningOf, NoVertices)
{
    BlendSkinning<TypeParam> skinning(Positions(0, 3), Weights{{0}, {}, {}});
    Positions posed(7, 3);
    skinning.linear(two_bones(), posed);
    EXPECT_EQ(posed.rows(), 0);
    skinning.dual_quaternion({}, posed);
    EXPECT_EQ(posed.rows(), 0);
}

TYPED_TEST(BlendSkinningOf, OneVertex)
{
    const Positions point = four_points.row(1);
    const Weights weights = {{0, 2}, {0, 1}, {0.25, 0.75}};
    BlendSkinning<TypeParam> skinning(point, weights);
    Positions posed, plain;
    skinning.dual_quaternion(two_bones(), posed);
    pbs::dual_quaternion_skinning(point, weights, two_bones(), plain);
    EXPECT_LT((posed - plain).norm(), std::sqrt(3.0) * dual_quaternion_error<TypeParam>());
}

TYPED_TEST(BlendSkinningOf, BonesWithoutVertices)  // bones 0 and 2 of four
{
    Pose pose(4, Eigen::Isometry3d::Identity());
    pose[0].translation() = pose[2].translation() = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    pose[1] = pose[3] = two_bones()[1];
    const Positions points = four_points.topRows(2);
    const Weights weights = {{0, 1, 3}, {1, 1, 3}, {1.0, 0.5, 0.5}};
    std::vector<TypeParam> posed(6);
    BlendSkinning<TypeParam> skinning(points, weights);
    for (const bool linear : {true, false}) {
        linear ? skinning.linear_rows(pose, Vec3::Zero(), posed.data()) : skinning.dual_quaternion_rows(pose, Vec3::Zero(), posed.data());
        for (int i = 0; i < 2; ++i) {
            const Vec3 expected = pose[1] * Vec3(points.row(i));
            const double rounding = linear ? linear_error<TypeParam>() : dual_quaternion_error<TypeParam>();
            for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(posed[3 * i + axis], expected[axis], rounding);
        }
    }
}

TYPED_TEST(BlendSkinningOf, ABrokenPoseIsAnOutcomeNotAnError)
{
    Pose pose = two_bones();
    pose[0].linear()(0, 0) = std::numeric_limits<double>::quiet_NaN();
    BlendSkinning<TypeParam> skinning(four_points, four_vertices);
    Positions posed;
    skinning.linear(pose, posed);
    EXPECT_FALSE(posed.row(1).allFinite());
    skinning.dual_quaternion(pose, posed);
    EXPECT_FALSE(posed.row(1).allFinite());
}

}  // namespace
