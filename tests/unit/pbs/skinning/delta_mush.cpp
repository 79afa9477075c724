// Reference: rigid motions, and the definition's limits. Tolerances: the rounding of means, and that of the polar decomposition by its
// condition.

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "tests/support/mush_rounding.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::DeltaMush;
using pbs::Positions;
using pbs::Vec3;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 60.0);

Positions mushed(const Positions& blended, const pbs::DeltaMushOptions& options = {}, const pbs::TetMesh& mesh = bent.mesh)
{
    Positions posed;
    DeltaMush(mesh, options).apply(blended, posed);
    return posed;
}

double mush_error(const Positions& blended, bool moved, double farthest)
{
    return test_support::mush_error<double>(bent.mesh, blended, moved, farthest);
}

TEST(DeltaMush, RestComesBack)
{
    EXPECT_LT((mushed(bent.mesh.rest) - bent.mesh.rest).cwiseAbs().maxCoeff(), mush_error(bent.mesh.rest, false, 1.0));
}

TEST(DeltaMush, TurnsWithARigidMotion)
{
    const Eigen::AngleAxisd turn(2.0, Vec3(1, 2, 3).normalized());
    const Vec3 moved(0.3, -0.2, 0.1);
    const auto place = [&](Positions positions) {
        for (auto row : positions.rowwise()) row = (turn * Vec3(row) + moved).transpose();
        return positions;
    };
    // Both sides of the second comparison are rounded, also by the motion, in some fifteen roundings.
    const double farthest = 1.1 + moved.norm(), of_motion = std::sqrt(3.0) * test_support::rounding_error(15, farthest);
    const double at_rest = mush_error(bent.mesh.rest, true, farthest) + of_motion,
                 blended = 2.0 * mush_error(bent.lbs, true, farthest) + of_motion;
    EXPECT_LT((mushed(place(bent.mesh.rest)) - place(bent.mesh.rest)).cwiseAbs().maxCoeff(), at_rest);
    EXPECT_LT((mushed(place(bent.lbs)) - place(mushed(bent.lbs))).cwiseAbs().maxCoeff(), blended);
    EXPECT_LT(at_rest + blended, 1e-9) << "a bound that would let a wrong rotation pass proves nothing";
}

TEST(DeltaMush, WithoutSmoothingItIsTheBlend)
{
    EXPECT_EQ(mushed(bent.lbs, {.iterations = 0}), bent.lbs);
    EXPECT_EQ(mushed(bent.lbs, {.iterations = 5, .step = 0.0}), bent.lbs);
}

// The bulge and the crease of a blend are its sharpest details: smoothing removes them, and the details that are restored are those of the
// rest shape.
TEST(DeltaMush, LosesLessOfEachTetThanTheBlend)
{
    const auto lost = [&](const Positions& positions) {
        return (pbs::tet_volumes(positions, bent.mesh.tets) - pbs::tet_volumes(bent.mesh.rest, bent.mesh.tets)).cwiseAbs().sum();
    };
    EXPECT_LT(lost(mushed(bent.lbs)), lost(bent.lbs));
}

TEST(DeltaMush, AVertexThatNoTetUsesFollowsTheBlend)
{
    pbs::TetMesh mesh = bent.mesh;
    mesh.rest.conservativeResize(mesh.rest.rows() + 1, 3);
    mesh.rest.bottomRows(1) << 5.0, 6.0, 7.0;
    Positions blended = mesh.rest;
    blended.bottomRows(1) << 1.0, 2.0, 3.0;
    EXPECT_EQ(mushed(blended, {}, mesh).bottomRows(1), blended.bottomRows(1));
}

TEST(DeltaMush, NotANumberIsNoRotation)
{
    Positions blended = bent.lbs;
    blended(3, 0) = std::nan("");
    EXPECT_FALSE(mushed(blended).allFinite());
}

// Reference: the plain code in double. Tolerance: the rounding of delta mush in float or double, to which LBS adds its own.

using pbs::PackedDeltaMush;

template <class Scalar>
class PackedDeltaMushOf : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PackedDeltaMushOf, Scalars);

template <class Scalar>
Positions packed_mush(const test_support::TwoBoneLimb& limb, const pbs::Pose& pose, const pbs::DeltaMushOptions& options = {})
{
    pbs::BlendSkinning<Scalar> skinning(limb.mesh.rest, limb.weights);
    Positions posed;
    PackedDeltaMush<Scalar>(limb.mesh, options).apply(skinning, pose, posed);
    return posed;
}

// LBS goes through some fifteen roundings, and both sides are rounded.
template <class Scalar>
double packed_error(int iterations = pbs::DeltaMushOptions().iterations)
{
    return 2.0 * test_support::mush_error<Scalar>(bent.mesh, bent.lbs, true, 1.1, iterations) +
           test_support::rounding_error_in<Scalar>(15, 1.1);
}

// The bound grows with the iterations, for rounding is assumed to add up, and the smoothed covariances become flat. With three iterations
// it is far below what delta mush changes, so that it proves the code; with twenty it still holds.
TYPED_TEST(PackedDeltaMushOf, IsThePlainOne)
{
    for (const int iterations : {1, 3, 20}) {
        const pbs::DeltaMushOptions options{.iterations = iterations};
        const Positions expected = mushed(bent.lbs, options);
        const double tolerance = packed_error<TypeParam>(iterations);
        EXPECT_LT((packed_mush<TypeParam>(bent, bent.pose, options) - expected).rowwise().norm().maxCoeff(), tolerance);
        if (iterations == 20) continue;
        EXPECT_GT((expected - bent.lbs).rowwise().norm().maxCoeff(), 10.0 * tolerance) << "a bound that passes LBS proves nothing";
    }
}

TYPED_TEST(PackedDeltaMushOf, LosesNoDigitsFarFromTheOrigin)
{
    const Vec3 far(1000.0, -2000.0, 500.0);
    pbs::Pose pose = bent.pose;
    for (Eigen::Isometry3d& bone : pose) bone.pretranslate(far);
    const Positions there = packed_mush<TypeParam>(bent, pose).rowwise() - far.transpose();
    const double of_translation = std::sqrt(3.0) * test_support::rounding_error_in<double>(4, far.norm() + 2.0);
    const double amplified = packed_error<double>() / test_support::rounding_error_in<double>(1, 1.1) * of_translation;
    EXPECT_LT((there - packed_mush<TypeParam>(bent, bent.pose)).rowwise().norm().maxCoeff(), 2.0 * packed_error<TypeParam>() + amplified);
}

TYPED_TEST(PackedDeltaMushOf, WithoutSmoothingItIsTheBlend)
{
    for (const pbs::DeltaMushOptions& options : {pbs::DeltaMushOptions{.iterations = 0}, {.iterations = 5, .step = 0.0}})
        EXPECT_LT((packed_mush<TypeParam>(bent, bent.pose, options) - bent.lbs).cwiseAbs().maxCoeff(),
                  (test_support::rounding_error_in<TypeParam>(15, 1.1)));
}

// Vertices on a line have no rotation of their own: the formulae refuse it, and the decomposition takes one of those that are nearest. The
// sharp end of a flat tet is refused likewise. All must be finite, and without a detail they are the smoothed blend.
TYPED_TEST(PackedDeltaMushOf, FlatMeshesAreMovedToo)
{
    test_support::TwoBoneLimb flat = bent;
    flat.mesh.rest.col(1) *= 1e-6;
    flat.mesh.rest.col(2) *= 1e-6;
    pbs::linear_blend_skinning(flat.mesh.rest, flat.weights, flat.pose, flat.lbs);
    const Positions posed = packed_mush<TypeParam>(flat, flat.pose), expected = mushed(flat.lbs, {}, flat.mesh);
    EXPECT_TRUE(posed.allFinite());
    // The detail along the bar has the rotation of the bar, which only the turn about its own axis leaves open.
    EXPECT_LT((posed - expected).rowwise().norm().maxCoeff(), 1e-3 * (expected - flat.mesh.rest).rowwise().norm().maxCoeff());
}

TYPED_TEST(PackedDeltaMushOf, AVertexThatNoTetUsesFollowsTheBlend)
{
    const test_support::TwoBoneLimb limb = test_support::with_loose_vertex(bent);
    EXPECT_LT((packed_mush<TypeParam>(limb, limb.pose).bottomRows(1) - limb.lbs.bottomRows(1)).norm(),
              std::sqrt(3.0) * test_support::rounding_error_in<TypeParam>(15, 1.5));
}

TYPED_TEST(PackedDeltaMushOf, NotANumberIsNoRotation)
{
    pbs::Pose pose = bent.pose;
    pose[1].linear()(0, 0) = std::nan("");
    EXPECT_FALSE(packed_mush<TypeParam>(bent, pose).allFinite());
}

}  // namespace
