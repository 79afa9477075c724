// Reference: binding, weights and blends are geometry, so they commute with rigid motions, renumbering, mirrors and changes of unit.
#include "tests/support/rounding_error.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace test_support;
using pbs::Positions;
using pbs::Vec3;

constexpr double farthest = 1.1, translation = 1.8;  // of the limb, and of a random motion, whose three coordinates are up to 1 m

const TwoBoneLimb limb = two_bone_limb({12, 3, 3}, Vec3(0.3, 0.2, 1.0), 80.0);

Positions blended(decltype(pbs::linear_blend_skinning) blend, const Positions& rest, const pbs::Weights& weights, const pbs::Pose& pose)
{
    Positions posed;
    blend(rest, weights, pose, posed);
    return posed;
}

const auto blends = {pbs::linear_blend_skinning, pbs::dual_quaternion_skinning};

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

TEST(SkinningInvariance, BlendsOfOneRigidMotionAreThatMotion)
{
    RandomPoints random(52);
    for (int trial = 0; trial < 20; ++trial) {
        const Eigen::Isometry3d motion = random.rigid_motion(1.0);
        const Positions expected = transformed(limb.mesh.rest, motion);
        for (const auto blend : blends)
            EXPECT_LT((blended(blend, limb.mesh.rest, limb.weights, {motion, motion}) - expected).cwiseAbs().maxCoeff(),
                      motion_error(1 + 1, farthest + translation));  // the expected motion and the blended one
    }
}

TEST(SkinningInvariance, BlendsAreCarriedByAMotionOfTheWholeBody)
{
    RandomPoints random(53);
    for (int trial = 0; trial < 20; ++trial) {
        const Eigen::Isometry3d motion = random.rigid_motion(1.0);
        pbs::Pose carried;
        for (const Eigen::Isometry3d& bone : limb.pose) carried.push_back(motion * bone);
        for (const auto blend : blends) {
            const Positions expected = transformed(blended(blend, limb.mesh.rest, limb.weights, limb.pose), motion);
            EXPECT_LT(
                (blended(blend, limb.mesh.rest, limb.weights, carried) - expected).cwiseAbs().maxCoeff(),
                motion_error(2 + 2, farthest + 1.0 + translation));  // the pose, which moves by up to 1 m, and the motion, on both sides
        }
    }
}

// The limb's blends against blends of the same limb after a map and in other bones' order. Two blends of its pose, which moves by up to 1
// m.
void expect_mapped(const Eigen::Matrix3d& map, const pbs::Weights& weights)
{
    pbs::Pose mapped = limb.pose;
    for (Eigen::Isometry3d& bone : mapped) {
        bone.linear() = (map * bone.linear() * map.inverse()).eval();
        bone.translation() = (map * bone.translation()).eval();
    }
    const double of_blends = motion_error(1 + 1, farthest + 1.0);
    for (const auto blend : blends) {
        const Positions expected = blended(blend, limb.mesh.rest, limb.weights, limb.pose),
                        found = blended(blend, limb.mesh.rest * map, weights, mapped) * map.inverse();
        EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), of_blends);
    }
}

TEST(SkinningInvariance, BlendsUnderAMirrorInAnotherUnitAndInAnyOrderOfTheBones)
{
    pbs::Weights swapped = limb.weights;
    for (int i = 0; i < swapped.vertices(); ++i) {
        std::reverse(swapped.bone.begin() + swapped.first[i], swapped.bone.begin() + swapped.first[i + 1]);
        std::reverse(swapped.weight.begin() + swapped.first[i], swapped.weight.begin() + swapped.first[i + 1]);
    }
    expect_mapped(Vec3(1, -1, 1).asDiagonal(), limb.weights);
    for (const double size : {1e-6, 1e6}) expect_mapped(size * Eigen::Matrix3d::Identity(), limb.weights);
    expect_mapped(Eigen::Matrix3d::Identity(), swapped);
}

}  // namespace
