// Reference: rigid motions, and the definition's limits. Tolerances: the rounding of means, and that of the polar decomposition by its
// condition.
#include "pbs/skinning/delta_mush.hpp"

#include "pbs/geometry/tet_mesh.hpp"
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

Positions mushed(const Positions& blended, const pbs::DeltaMushOptions& options = {})
{
    Positions posed;
    DeltaMush(bent.mesh, options).apply(blended, posed);
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
    Positions posed, blended = mesh.rest;
    blended.bottomRows(1) << 1.0, 2.0, 3.0;
    DeltaMush(mesh, {}).apply(blended, posed);
    EXPECT_EQ(posed.bottomRows(1), blended.bottomRows(1));
}

TEST(DeltaMush, NotANumberIsNoRotation)
{
    Positions blended = bent.lbs;
    blended(3, 0) = std::nan("");
    EXPECT_FALSE(mushed(blended).allFinite());
}

}  // namespace
