// Reference: binding and weights are geometry, so they commute with rigid motions, renumbering, mirrors and changes of
// unit. The same of the skinners: tests/unit/pbs/skinning/contract.cpp.
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace skinning_invariance_tests {
namespace {

using namespace test_support;
using pbs::Positions;
using pbs::Vec3;

constexpr double farthest = 1.1,
                 translation = 1.8;  // of the limb, and of a random motion, whose three coordinates are up to 1 m

const TwoBoneLimb limb = two_bone_limb({12, 3, 3}, Vec3(0.3, 0.2, 1.0), 80.0);

pbs::Skeleton mapped(pbs::Skeleton skeleton, const Eigen::Affine3d& map)
{
    for (pbs::Bone& bone : skeleton.bones) {
        bone.head = map * bone.head;
        bone.tail = map * bone.tail;
    }
    return skeleton;
}

// Whether a vertex lies within 1e-6 of the bounds of Eq. 2 or of a bone's ends, where rounding may decide.
bool undecided(int vertex)
{
    const double t = limb.binding.parameter(vertex);
    return std::min({std::abs(t - 1.0 / 6.0), std::abs(t - 5.0 / 6.0), std::abs(t), std::abs(t - 1.0)}) < 1e-6;
}

TEST(SkinningInvariance, BindingAndWeightsUnderSimilarities)
{
    RandomPoints random(51);
    for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        const Eigen::Affine3d map = Eigen::Affine3d(random.rigid_motion(1.0)) * Eigen::Scaling(size);
        const Positions rest = (limb.mesh.rest * map.linear().transpose()).rowwise() + map.translation().transpose();
        const pbs::Skeleton skeleton = mapped(limb.skeleton, map);
        const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(rest, skeleton);
        const pbs::Weights weights = pbs::paper_weights(binding, skeleton);
        // The vertex and both ends of a bone of unit length are moved, and projected on it in as many roundings.
        const double tolerance = 4.0 * motion_error(1, farthest + translation / size);
        for (int i = 0; i < rest.rows(); ++i) {
            if (undecided(i)) continue;
            EXPECT_EQ(binding.bone[i], limb.binding.bone[i]);
            EXPECT_NEAR(binding.parameter(i), limb.binding.parameter(i), tolerance);
            EXPECT_NEAR(binding.distance(i) / size, limb.binding.distance(i), tolerance);
            EXPECT_EQ(weights.blended(i), limb.weights.blended(i));
        }
    }
}

TEST(SkinningInvariance, BindingAndWeightsUnderRenumbering)
{
    const Positions reversed = limb.mesh.rest.colwise().reverse();
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(reversed, limb.skeleton);
    const pbs::Weights weights = pbs::paper_weights(binding, limb.skeleton);
    const int last = static_cast<int>(reversed.rows()) - 1;
    for (int i = 0; i <= last; ++i) {
        EXPECT_EQ(binding.bone[i], limb.binding.bone[last - i]);
        EXPECT_EQ(binding.distance(i), limb.binding.distance(last - i));
        EXPECT_EQ(weights.blended(i), limb.weights.blended(last - i));
    }
}

TEST(SkinningInvariance, WeightsUnderAMirror)
{
    Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
    mirror.linear().diagonal() << 1, -1, 1;
    const Positions rest = limb.mesh.rest * mirror.linear();
    const pbs::Skeleton skeleton = mapped(limb.skeleton, mirror);
    const pbs::Weights weights = pbs::paper_weights(pbs::bind_to_nearest_bone(rest, skeleton), skeleton);
    EXPECT_EQ(weights.first, limb.weights.first);
    EXPECT_EQ(weights.bone, limb.weights.bone);
    EXPECT_EQ(weights.weight, limb.weights.weight);
}

// Reference: the plain blends, which follow the paper line by line; in any number of vertices and bones, far from the
// origin and in any unit.

using pbs::BlendSkinning;
using pbs::Pose;
using pbs::Weights;

template <class Scalar>
class PackedBlends : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PackedBlends, Scalars);

constexpr int bones = 12;

// Numbers of order one go through some 40 roundings (8 bones, 4 columns, two cross products). DQS divides by |r|^2 of
// the blend. The largest weight of n bones gives |r| >= 1 / n, which amplifies them.
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
    for (int most = 1; most <= 8; ++most)
        expect_as_plain<TypeParam>(random_body(70 + most, 500, most), tolerance<TypeParam>(most));
    for (int vertices = 1; vertices < 40; ++vertices)
        expect_as_plain<TypeParam>(random_body(80 + vertices, vertices, 3), tolerance<TypeParam>(3));
    // long stretches
    const RowPattern all_own = {1, 0, 2}, all_shared = {2, 1, 2}, one_matrix = {50, 49}, changing = {200, 80, 2};
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

// Antipodal: rotations by 110 and -110 degrees are 140 degrees apart; their quaternions with a positive scalar part lie
// in opposite hemispheres. At a distance of 10 km the spacing of floats is 1 mm. Blending about the body's middle
// leaves only the roundings that occur near the origin. The plain blends in double round coordinates of that size.
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

}  // namespace
}  // namespace skinning_invariance_tests
