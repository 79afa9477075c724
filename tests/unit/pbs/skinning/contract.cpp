// The contract of the skinners: LBS, dual quaternions, delta mush, direct delta mush and correctives, plain and packed.
// References: rigid motions, the limits of the definitions, and of packed code the plain one. Tolerances:
// tests/support/skinners.hpp.
#include "tests/support/random_points.hpp"
#include "tests/support/skinners.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace skinner_contract_tests {
namespace {

using namespace test_support;

const Pose rest_pose(2, Eigen::Isometry3d::Identity());

double largest(const Positions& difference)
{
    return difference.rowwise().norm().maxCoeff();
}

// The limb with one more vertex, which no tet uses and the forearm alone moves.
TwoBoneLimb with_loose_vertex(TwoBoneLimb limb)
{
    const Eigen::Index last = limb.mesh.rest.rows();
    limb.mesh.rest.conservativeResize(last + 1, 3);
    limb.mesh.rest.row(last) << 0.9, 0.5, 0.25;
    limb.weights.first.push_back(limb.weights.first.back() + 1);
    limb.weights.bone.push_back(1);
    limb.weights.weight.push_back(1.0);
    pbs::linear_blend_skinning(limb.mesh.rest, limb.weights, limb.pose, limb.lbs);
    return limb;
}

template <typename Method>
class Skinner : public testing::Test {
};
using Skinners = testing::Types<Blend<double, false, true>, Blend<float, true, true>, Blend<double, true, true>,
                                Blend<double, false, false>, Blend<float, true, false>, Blend<double, true, false>,
                                Delta<double, false>, Delta<float, true>, Delta<double, true>, Direct<double, false>,
                                Direct<float, true>, Direct<double, true>, Corrective<double, false>,
                                Corrective<float, true>, Corrective<double, true>>;
TYPED_TEST_SUITE(Skinner, Skinners);

TYPED_TEST(Skinner, IsThePlainOne)
{
    if (!TypeParam::packed) return;
    for (const auto& options : TypeParam::settings) {
        const Positions expected = TypeParam::Plain::applied(TypeParam::limb, TypeParam::limb.pose, options);
        const double tolerance = TypeParam::packed_error(options);
        EXPECT_LT(largest(TypeParam::applied(TypeParam::limb, TypeParam::limb.pose, options) - expected), tolerance);
        EXPECT_TRUE(!TypeParam::proves(options) || largest(expected - TypeParam::limb.lbs) > 10.0 * tolerance)
            << "a bound that passes LBS proves nothing";
    }
}

TYPED_TEST(Skinner, RestComesBack)
{
    const Positions& rest = TypeParam::limb.mesh.rest;
    for (const auto& options : TypeParam::settings)
        EXPECT_LT(largest(TypeParam::applied(TypeParam::limb, rest_pose, options) - rest),
                  TypeParam::error(options, rest_pose, 1.0));
}

// The rest shape by one motion of all bones, and a pose with a motion after it. Both sides are rounded, also by the
// motion.
TYPED_TEST(Skinner, TurnsWithARigidMotion)
{
    RandomPoints random(51);
    const double farthest = 1.1 + 0.2 * std::sqrt(3.0), of_motion = motion_error(1, farthest);
    const double proof = std::is_same_v<TypeParam, Direct<double, false>> ? 1e-6 : 1e-9;  // it solves with a matrix
    const TwoBoneLimb& limb = TypeParam::limb;
    for (int trial = 0; trial < 5; ++trial)
        for (const auto& options : TypeParam::settings) {
            const Eigen::Isometry3d motion = random.rigid_motion(0.2);
            Pose moved = limb.pose;
            for (Eigen::Isometry3d& bone : moved) bone = motion * bone;
            const double at_rest = TypeParam::error(options, Pose(2, motion), farthest) + of_motion,
                         posed = 2.0 * TypeParam::error(options, moved, farthest) + of_motion;
            EXPECT_LT(largest(TypeParam::applied(limb, Pose(2, motion), options) - transformed(limb.mesh.rest, motion)),
                      at_rest);
            EXPECT_LT(largest(TypeParam::applied(limb, moved, options) -
                              transformed(TypeParam::applied(limb, limb.pose, options), motion)),
                      posed);
            EXPECT_TRUE(TypeParam::packed || at_rest + posed < proof)
                << "a bound that would let a wrong rotation pass proves nothing";
        }
}

// The limb after a linear map of all points, which multiplies lengths by a factor.
TwoBoneLimb mapped(TwoBoneLimb limb, const Eigen::Matrix3d& map)
{
    limb.mesh.rest *= map.transpose();
    for (Eigen::Isometry3d& bone : limb.pose) {
        bone.linear() = (map * bone.linear() * map.inverse()).eval();
        bone.translation() = (map * bone.translation()).eval();
    }
    return limb;
}

// The limb's vertices in another order, and the bones of each in the opposite one. Vertex v becomes place[v].
TwoBoneLimb renumbered(const TwoBoneLimb& limb, std::vector<int>& place)
{
    TwoBoneLimb other = limb;
    const int n = static_cast<int>(limb.mesh.rest.rows());
    std::vector<int> vertex_at(n);
    place.resize(n);
    EXPECT_EQ(std::gcd(31, n), 1);
    for (int v = 0; v < n; ++v) place[v] = (v * 31 + 7) % n, vertex_at[place[v]] = v;
    other.mesh.rest = limb.mesh.rest(vertex_at, Eigen::all);
    for (int& v : other.mesh.tets.reshaped()) v = place[v];
    other.weights = {{0}, {}, {}};
    for (const int v : vertex_at) {
        for (int k = limb.weights.first[v + 1]; k-- > limb.weights.first[v];)
            other.weights.add(limb.weights.bone[k], limb.weights.weight[k]);
        other.weights.end_vertex();
    }
    return other;
}

TYPED_TEST(Skinner, FollowsAMirrorAnotherUnitAndAnyOrderOfVerticesAndBones)
{
    const TwoBoneLimb& limb = TypeParam::limb;
    for (const auto& options : TypeParam::settings) {
        const Positions expected = TypeParam::applied(limb, limb.pose, options);
        const double tolerance = 2.0 * TypeParam::error(options, limb.pose, 1.1 + 1.0);  // the pose moves by up to 1 m
        const Eigen::Matrix3d mirror = Vec3(1, -1, 1).asDiagonal(), identity = Eigen::Matrix3d::Identity();
        for (const Eigen::Matrix3d& map : {mirror, Eigen::Matrix3d(1e-6 * identity), Eigen::Matrix3d(1e6 * identity)}) {
            const TwoBoneLimb other = mapped(limb, map);
            EXPECT_LT(largest(TypeParam::applied(other, other.pose, options) * map.inverse().transpose() - expected),
                      tolerance)
                << map.diagonal().transpose();
        }
        std::vector<int> place;
        const TwoBoneLimb other = renumbered(limb, place);
        EXPECT_LT(largest(TypeParam::applied(other, limb.pose, options)(place, Eigen::all) - expected), tolerance);
    }
}

TYPED_TEST(Skinner, LosesNoDigitsFarFromTheOrigin)
{
    if (!TypeParam::packed) return;
    const Vec3 far(1000.0, -2000.0, 500.0);
    Pose pose = TypeParam::limb.pose;
    for (Eigen::Isometry3d& bone : pose) bone.pretranslate(far);
    for (const auto& options : TypeParam::settings) {
        const Positions here = TypeParam::applied(TypeParam::limb, TypeParam::limb.pose, options),
                        there = TypeParam::applied(TypeParam::limb, pose, options);
        EXPECT_LT(largest(there.rowwise() - far.transpose() - here), TypeParam::far_error(options, pose, far.norm()));
    }
}

TYPED_TEST(Skinner, WithoutSmoothingItIsTheBlend)
{
    for (const auto& options : TypeParam::without_smoothing)
        EXPECT_LE((TypeParam::applied(TypeParam::limb, TypeParam::limb.pose, options) - TypeParam::limb.lbs)
                      .cwiseAbs()
                      .maxCoeff(),
                  TypeParam::blend_error());
}

TYPED_TEST(Skinner, AVertexThatNoTetUsesFollowsTheBlend)
{
    const TwoBoneLimb limb = with_loose_vertex(TypeParam::limb);
    const double farther = 1.36;  // 1.5 m from the origin instead of 1.1 m
    EXPECT_LE((TypeParam::applied(limb, limb.pose, {}) - limb.lbs).bottomRows(1).norm(),
              farther * TypeParam::blend_error());
}

TYPED_TEST(Skinner, NotANumberIsNoRotation)
{
    Pose pose = TypeParam::limb.pose;
    pose[1].linear()(0, 0) = std::nan("");
    EXPECT_FALSE(TypeParam::applied(TypeParam::limb, pose, {}).allFinite());
}

}  // namespace
}  // namespace skinner_contract_tests
