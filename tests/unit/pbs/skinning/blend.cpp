// The contract of the blends, plain and packed. Reference: closed forms of two bones blended half and half, the rest
// pose and rigid transforms. Tolerances: the rounding of motions, two for a linear blend and its closed form and three
// where rotations become quaternions and back.

#include "pbs/skinning/blend.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

namespace blend_tests {
namespace {

using pbs::BlendSkinning;
using pbs::Pose;
using pbs::Positions;
using pbs::Vec3;
using pbs::Weights;

constexpr double degree = std::numbers::pi / 180.0;

struct Plain {
    using Scalar = double;
    void linear(const Pose& pose, Positions& posed) const { pbs::linear_blend_skinning(rest, weights, pose, posed); }
    void dual_quaternion(const Pose& pose, Positions& posed) const
    {
        pbs::dual_quaternion_skinning(rest, weights, pose, posed);
    }

    Positions rest;
    Weights weights;
};

template <class S>
struct Packed : BlendSkinning<S> {
    using Scalar = S;
    using BlendSkinning<S>::BlendSkinning;
};

template <class Skinning>
class BlendOf : public testing::Test {
protected:
    using Scalar = typename Skinning::Scalar;

    static Positions linear(const Positions& rest, const Weights& weights, const Pose& pose)
    {
        Positions posed(7, 3);
        Skinning{rest, weights}.linear(pose, posed);
        return posed;
    }
    static Positions dual_quaternion(const Positions& rest, const Weights& weights, const Pose& pose)
    {
        Positions posed(7, 3);
        Skinning{rest, weights}.dual_quaternion(pose, posed);
        return posed;
    }
    static Vec3 linear(const Vec3& point, const Pose& pose)
    {
        return linear(point.transpose(), half_and_half, pose).row(0);
    }
    static Vec3 dual_quaternion(const Vec3& point, const Pose& pose)
    {
        return dual_quaternion(point.transpose(), half_and_half, pose).row(0);
    }
    static double motion_error(int motions, double farthest)
    {
        return test_support::motion_error(motions, farthest) *
               (std::numeric_limits<Scalar>::epsilon() / std::numeric_limits<double>::epsilon());
    }
    static Pose moved(const Vec3& axis, double angle_deg)
    {
        const pbs::Skeleton limb = {{{"upper", -1, {-1, 0, 0}, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, {1, 0, 0}}}};
        return pbs::joint_sweep(limb, 1, axis, angle_deg, 2, 0.01).steps[1];
    }
    static Pose twisted(double angle_deg) { return moved(Vec3::UnitX(), angle_deg); }

    inline static const Weights half_and_half = {{0, 2}, {0, 1}, {0.5, 0.5}};
};
using Blends = testing::Types<Plain, Packed<float>, Packed<double>>;
TYPED_TEST_SUITE(BlendOf, Blends);

TYPED_TEST(BlendOf, LinearShrinksATwistByTheCosineOfHalfTheAngle)
{
    for (const double angle_deg : {10.0, 90.0, 150.0, 180.0})  // 180: the candy wrapper, radius zero
        EXPECT_NEAR(this->linear({0, 0.2, 0}, this->twisted(angle_deg)).template tail<2>().norm(),
                    0.2 * std::cos(angle_deg / 2 * degree), this->motion_error(2, 0.2))
            << angle_deg;
}

TYPED_TEST(BlendOf, DualQuaternionsKeepTheRadiusOfATwistAndHalveItsAngle)
{
    for (const double angle_deg : {10.0, 90.0, 150.0, 179.0}) {
        const Vec3 expected = 0.2 * Vec3(0, std::cos(angle_deg / 2 * degree), std::sin(angle_deg / 2 * degree));
        EXPECT_LT((this->dual_quaternion({0, 0.2, 0}, this->twisted(angle_deg)) - expected).norm(),
                  this->motion_error(3, 0.2))
            << angle_deg;
    }
}

TYPED_TEST(BlendOf, DualQuaternionsBulgeWhereABendIsBlended)
{
    const Pose bent = this->moved(Vec3::UnitZ(), 90.0);
    // a circle; LBS cuts the corner
    EXPECT_NEAR(this->dual_quaternion({0, -0.2, 0}, bent).norm(), 0.2, this->motion_error(3, 0.2));
    EXPECT_NEAR(this->linear({0, -0.2, 0}, bent).norm(), 0.2 * std::cos(45.0 * degree), this->motion_error(2, 0.2));
}

// Rotations by 170 and -170 degrees are 20 degrees apart; their quaternions lie in opposite hemispheres. An entry
// without weight must not determine the hemisphere of the others: 180 lies between 100 and 260.
TYPED_TEST(BlendOf, TakesTheShortWayAndPivotsOnTheHeaviestBone)
{
    const auto turned = [](std::vector<double> angles_deg) {
        Pose pose(angles_deg.size(), Eigen::Isometry3d::Identity());
        for (std::size_t bone = 0; bone < pose.size(); ++bone)
            pose[bone].linear() = Eigen::AngleAxisd(angles_deg[bone] * degree, Vec3::UnitX()).toRotationMatrix();
        return pose;
    };
    const Weights with_zero = {{0, 3}, {0, 1, 2}, {0.0, 0.5, 0.5}};
    for (const auto& [weights, pose] :
         {std::pair(this->half_and_half, turned({170, -170})), {with_zero, turned({0, 100, -100})}}) {
        const Positions posed = this->dual_quaternion(Vec3(0, 1, 0).transpose(), weights, pose);
        EXPECT_LT((posed.row(0).transpose() - Vec3(0, -1, 0)).norm(), this->motion_error(3, 1.0));
    }
}

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
const Positions four_points =
    (Positions(4, 3) << 0.125, 0.5, -0.25, 0.25, -0.5, 1.0, -1.0, 0.0, 0.75, 0.5, 0.5, 0.5).finished();

TYPED_TEST(BlendOf, LeavesTheRestPoseWhereItIs)
{
    const Pose rest(2, Eigen::Isometry3d::Identity());
    EXPECT_EQ(this->linear(four_points, four_vertices, rest), four_points);
    EXPECT_EQ(this->dual_quaternion(four_points, four_vertices, rest), four_points);
}

TYPED_TEST(BlendOf, MovesAVertexOfOneBoneWithTheBone)
{
    const Vec3 expected = two_bones()[1] * Vec3(four_points.row(0));
    const Positions linear = this->linear(four_points, four_vertices, two_bones()),
                    dual = this->dual_quaternion(four_points, four_vertices, two_bones());
    for (const Positions& posed : {linear, dual})
        EXPECT_LT((posed.row(0).transpose() - expected).norm(), this->motion_error(3 + 1, 1.7 + 2.3));
    if (!std::is_same_v<TypeParam, Plain>) {
        EXPECT_EQ(linear.row(0), dual.row(0)) << "packed code moves it by one matrix in both";
    }
}

TYPED_TEST(BlendOf, OfNoVerticesIsEmpty)
{
    const Weights none{{0}, {}, {}};
    EXPECT_EQ(this->linear(Positions(0, 3), none, two_bones()).rows(), 0);
    EXPECT_EQ(this->dual_quaternion(Positions(0, 3), none, {}).rows(), 0);
}

// Reference: rows of weights written by hand.

using pbs::PackedWeights;

// Vertices 0, 3: only bone 2; 1, 4: equal parts of 0 and 1; 2: its own row, whose second bone has the largest weight.
const Weights five_vertices = {
    {0, 1, 3, 5, 6, 8}, {2, 0, 1, 0, 1, 2, 0, 1}, {1.0, 0.5, 0.5, 0.25, 0.75, 1.0, 0.5, 0.5}};

using Kind = pbs::VertexStretch::Kind;

std::vector<std::tuple<Kind, int, int>> stretches_of(const Weights& weights)
{
    std::vector<std::tuple<Kind, int, int>> stretches;
    for (const pbs::VertexStretch& stretch : pbs::pack_weights<double>(weights).stretches)
        stretches.emplace_back(stretch.kind, stretch.first, stretch.last);
    return stretches;
}

TEST(PackedWeights, OneBoneOrASharedRowIsAMatrixAndARowOfOneVertexItsOwn)
{
    const PackedWeights<float> packed = pbs::pack_weights<float>(five_vertices);
    EXPECT_EQ(packed.bones, 3);
    // 3: after the bones
    EXPECT_TRUE(std::equal(packed.matrix.begin(), packed.matrix.begin() + 5, std::vector{2, 3, -1, 2, 3}.begin()));
    EXPECT_EQ(packed.shared.rows(), 1);
    EXPECT_EQ(packed.shared.bone, (std::vector<int>{0, 1}));
    EXPECT_EQ(packed.own.rows(), 1);
    EXPECT_EQ(packed.own.weight, (std::vector<float>{0.25F, 0.75F}));
}

// Many vertices of one matrix are a stretch of their own.
TEST(PackedWeights, StretchesCoverTheVerticesInOrder)
{
    using Stretches = std::vector<std::tuple<Kind, int, int>>;
    EXPECT_EQ(stretches_of(five_vertices),
              (Stretches{{Kind::matrix_each, 0, 2}, {Kind::own_rows, 2, 3}, {Kind::matrix_each, 3, 5}}));
    Weights rigid = {{0}, {}, std::vector<double>(300, 1.0)};
    for (int vertex = 0; vertex < 300; ++vertex) {
        rigid.bone.push_back(vertex < 100 ? vertex % 2 : vertex < 200 ? 2 : 3);
        rigid.first.push_back(vertex + 1);
    }
    EXPECT_EQ(stretches_of(rigid),
              (Stretches{{Kind::matrix_each, 0, 100}, {Kind::one_matrix, 100, 200}, {Kind::one_matrix, 200, 300}}));
}

TEST(PackedWeights, TheHeaviestBoneIsThePivotAndEachPairStandsOnce)
{
    const auto bones = pbs::pack_weights<double>(five_vertices).turned_bones;
    // the first of equal weights; then vertex 2's
    EXPECT_EQ(bones, (std::vector<pbs::TurnedBone>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));
}

TEST(PackedWeights, WeightsOfZeroAreLeftOutAndRowsInAnotherOrderAreOthers)
{
    const PackedWeights<double> packed =
        pbs::pack_weights<double>({{0, 3, 5}, {0, 1, 2, 1, 4}, {0.0, 0.5, 0.5, 0.0, 1.0}});
    EXPECT_EQ(packed.own.bone, (std::vector<int>{1, 2}));
    EXPECT_EQ(packed.matrix[1], 4);  // one bone remains, so it moves the vertex rigidly
    // Rows in another order are others: sums in another order are rounded differently.
    EXPECT_EQ(pbs::pack_weights<double>({{0, 2, 4}, {0, 1, 1, 0}, {0.5, 0.5, 0.5, 0.5}}).own.rows(), 2);
    const PackedWeights<float> none = pbs::pack_weights<float>({{0}, {}, {}});
    EXPECT_EQ(none.bones, 0);
    EXPECT_TRUE(none.matrix.empty() && none.stretches.empty());
}

// Reference: the plain blend, a rigid transform, and the caller's memory. Tolerances: the roundings of a blend.

template <class Scalar>
class BlendSkinningOf : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BlendSkinningOf, Scalars);

// Coordinates [m] of these points, which are rounded relative to an origin at that distance. The norm of a point
// relative to the body's middle is at most 1.7, and that of a translation of the middle is at most 2.3. An entry of a
// matrix is rounded once and blended in two roundings for each of two bones; its product with a coordinate and three
// sums follow, and the reference rounds as often.
template <class Scalar>
double linear_error(double origin = 0.0)
{
    return test_support::rounding_error_in<Scalar>(2 * (1 + 2 * 2 + 1 + 3), 1.7 + 2.3 + origin);
}

// The same for dual quaternions. The five roundings of their entries occur twice in an entry of the matrix, with two of
// a product and a sum, and twice more in |r|^2, with four of its products and sums; |r|^2 >= 1/4 + 1/4 of two bones
// divides.
template <class Scalar>
double dual_quaternion_error()
{
    return test_support::rounding_error_in<Scalar>(2 * (2 * 5 + 2 + 2 * 5 + 4 + 1 + 1 + 3), 2.0 * (1.7 + 2.3));
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

// The blend moves a point rigidly if its weights are kept: the columns of its rotation are what it does to the axes.
TYPED_TEST(BlendSkinningOf, RotationsAreThoseOfTheDualQuaternions)
{
    BlendSkinning<TypeParam> skinning(four_points, four_vertices);
    std::vector<Eigen::Matrix3d> rotations;
    skinning.rotations(two_bones(), rotations);
    ASSERT_EQ(rotations.size(), 4u);
    Positions here, there;
    pbs::dual_quaternion_skinning(four_points, four_vertices, two_bones(), here);
    for (int axis = 0; axis < 3; ++axis) {
        Positions moved = four_points;
        moved.col(axis).array() += 1.0;
        pbs::dual_quaternion_skinning(moved, four_vertices, two_bones(), there);
        for (int i = 0; i < 4; ++i)
            EXPECT_LT((rotations[i].col(axis).transpose() - (there - here).row(i)).cwiseAbs().maxCoeff(),
                      2.0 * dual_quaternion_error<TypeParam>());
    }
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
        linear ? skinning.linear_rows(pose, Vec3::Zero(), posed.data())
               : skinning.dual_quaternion_rows(pose, Vec3::Zero(), posed.data());
        for (int i = 0; i < 2; ++i) {
            const Vec3 expected = pose[1] * Vec3(points.row(i));
            const double rounding = linear ? linear_error<TypeParam>() : dual_quaternion_error<TypeParam>();
            for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(posed[3 * i + axis], expected[axis], rounding);
        }
    }
}

}  // namespace
}  // namespace blend_tests
