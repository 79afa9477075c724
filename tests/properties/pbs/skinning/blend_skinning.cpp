// Reference: the plain blends, which follow the paper line by line; in any number of vertices and bones, far from the origin and in any
// unit.
#include "pbs/skinning/blend.hpp"

#include "tests/support/random_points.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace {

using namespace test_support;
using pbs::BlendSkinning;
using pbs::Pose;
using pbs::Positions;
using pbs::Vec3;
using pbs::Weights;

template <class Scalar>
class PackedBlends : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PackedBlends, Scalars);

constexpr int bones = 12;

// Numbers of order one go through some 40 roundings (8 bones, 4 columns, two cross products). DQS divides by |r|^2 of the blend. The
// largest weight of n bones gives |r| >= 1 / n, which amplifies them.
template <class Scalar>
double tolerance(int bones_a_vertex)
{
    return 40.0 * bones_a_vertex * std::numeric_limits<Scalar>::epsilon();
}

struct RandomBody {
    Positions rest;
    Weights weights{{0}, {}, {}};
    Pose pose;
};

// In each `period` of vertices, the last `repeats` have the same weights as the vertex before them.
struct RowPattern {
    int period = 3, repeats = 1, fewest_bones = 1;
};

// Each vertex has `fewest_bones` to `most` bones.
RandomBody random_body(unsigned seed, int vertices, int most, const RowPattern& pattern = {})
{
    RandomPoints random(seed);
    RandomBody body;
    body.rest.resize(vertices, 3);
    Weights& weights = body.weights;
    for (int bone = 0; bone < bones; ++bone) body.pose.push_back(random.rigid_motion(1.0));
    for (int i = 0; i < vertices; ++i) {
        body.rest.row(i) = random.point(1.0);
        const int count = static_cast<int>(random.number(pattern.fewest_bones, most + 0.999));
        const int begin = weights.first[i], first = static_cast<int>(random.number(0.0, bones - 0.001));
        double sum = 0.0;
        for (int k = 0; k < count; ++k) {
            weights.bone.push_back((first + 5 * k) % bones);
            weights.weight.push_back(count == 1 ? 1.0 : random.number(0.1, 1.0));
            sum += weights.weight.back();
        }
        for (int k = 0; k < count; ++k) weights.weight[begin + k] /= sum;
        if (i % pattern.period >= pattern.period - pattern.repeats) {
            weights.bone.resize(begin), weights.weight.resize(begin);
            for (int entry = weights.first[i - 1]; entry < begin; ++entry) {
                weights.bone.push_back(int{weights.bone[entry]});
                weights.weight.push_back(double{weights.weight[entry]});
            }
        }
        weights.first.push_back(static_cast<int>(weights.bone.size()));
    }
    return body;
}

template <class Scalar>
void expect_as_plain(const RandomBody& body, double tolerance)
{
    BlendSkinning<Scalar> skinning(body.rest, body.weights);
    Positions plain, posed;
    pbs::linear_blend_skinning(body.rest, body.weights, body.pose, plain);
    skinning.linear(body.pose, posed);
    EXPECT_LT((posed - plain).cwiseAbs().maxCoeff(), tolerance);
    pbs::dual_quaternion_skinning(body.rest, body.weights, body.pose, plain);
    skinning.dual_quaternion(body.pose, posed);
    EXPECT_LT((posed - plain).cwiseAbs().maxCoeff(), tolerance);
}

TYPED_TEST(PackedBlends, AreThePlainOnesForAnyNumberOfVerticesAndBones)
{
    for (int most = 1; most <= 8; ++most) expect_as_plain<TypeParam>(random_body(70 + most, 500, most), tolerance<TypeParam>(most));
    for (int vertices = 1; vertices < 40; ++vertices)
        expect_as_plain<TypeParam>(random_body(80 + vertices, vertices, 3), tolerance<TypeParam>(3));
    const RowPattern all_own = {1, 0, 2}, all_shared = {2, 1, 2}, one_matrix = {50, 49}, changing = {200, 80, 2};  // long stretches
    for (const RowPattern& pattern : {all_own, all_shared, one_matrix, changing})
        expect_as_plain<TypeParam>(random_body(69, 600, 4, pattern), tolerance<TypeParam>(4));
}

TYPED_TEST(PackedBlends, DoNotRememberTheLastPose)
{
    const RandomBody body = random_body(60, 200, 4), other = random_body(61, 1, 4);
    BlendSkinning<TypeParam> skinning(body.rest, body.weights);
    Positions once, again;
    skinning.dual_quaternion(body.pose, once);
    skinning.linear(other.pose, again);
    skinning.dual_quaternion(body.pose, again);
    EXPECT_EQ(once, again);
}

// Antipodal: rotations by 110 and -110 degrees are 140 degrees apart; their quaternions with a positive scalar part lie in opposite
// hemispheres. At a distance of 10 km the spacing of floats is 1 mm. Blending about the body's middle leaves only the roundings that occur
// near the origin. The plain blends in double round coordinates of that size.
TYPED_TEST(PackedBlends, AreThePlainOnesInAntipodalAndFarPosesAndInAnyUnit)
{
    const RandomBody body = random_body(65, 300, 6);
    RandomBody antipodal = body, there = body;
    for (int bone = 0; bone < bones; ++bone) {
        const double angle = (bone % 2 == 0 ? 110.0 : -110.0) * std::numbers::pi / 180.0;
        antipodal.pose[bone].linear() = Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix();
    }
    expect_as_plain<TypeParam>(antipodal, tolerance<TypeParam>(6));

    const Vec3 far(1e4, -1e4, 1e4);
    for (Eigen::Isometry3d& bone : there.pose) bone = Eigen::Translation3d(far) * bone * Eigen::Translation3d(-far);
    there.rest.rowwise() += far.transpose();
    expect_as_plain<TypeParam>(there, tolerance<TypeParam>(6) + far.norm() * tolerance<double>(6));

    for (const double size : {1e-6, 1e6}) {
        RandomBody scaled = body;
        scaled.rest *= size;
        for (Eigen::Isometry3d& bone : scaled.pose) bone.translation() *= size;
        expect_as_plain<TypeParam>(scaled, size * tolerance<TypeParam>(6));
    }
}

TYPED_TEST(PackedBlends, AreThePlainOnesInOneRigidMotion)
{
    RandomBody body = random_body(62, 300, 5);
    RandomPoints random(63);
    for (int trial = 0; trial < 20; ++trial) {
        body.pose.assign(bones, random.rigid_motion(1.0));
        expect_as_plain<TypeParam>(body, tolerance<TypeParam>(1));
    }
}

}  // namespace
