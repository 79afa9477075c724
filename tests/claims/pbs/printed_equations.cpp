// Tests whether Eq. 12-21 are the gradients and corrections of Eq. 11. Reference: the volumes themselves. Each form,
// derived and as printed, runs on a limb bent by 90 degrees (k_stretch 0.5, 24 iterations) and is measured by the sum
// of |V - V0| over the rest volume, in per cent.
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Outcome;
using pbs::Vec3;
using pbs::VolumeForm;
using test_support::TwoBoneLimb;

const TwoBoneLimb at_the_joint = test_support::two_bone_limb({40, 6, 6}, Vec3::UnitZ(), 90.0);
const TwoBoneLimb a_metre_away = test_support::two_bone_limb({40, 6, 6}, Vec3::UnitZ(), 90.0, Vec3(0, 1, 0));

double abs_change_pct(const TwoBoneLimb& limb, const pbs::Positions& positions)
{
    const Eigen::VectorXd rest = pbs::tet_volumes(limb.mesh.rest, limb.mesh.tets);
    return 100.0 * (pbs::tet_volumes(positions, limb.mesh.tets) - rest).cwiseAbs().sum() / rest.sum();
}

struct Finding {
    Outcome outcome;
    double change_pct;
};

Finding run(const TwoBoneLimb& limb, VolumeForm form, pbs::Precision precision = pbs::Precision::f64)
{
    pbs::PbsOptions options;
    options.k_stretch = 0.5;
    options.precision = precision;
    options.volume_form = form;
    options.order = pbs::Order::plain;
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, options);
    const Outcome outcome = solver.advance(limb.lbs, limb.bind_points, 0.01).outcome;
    return {outcome, abs_change_pct(limb, solver.positions())};
}

const double lbs_pct = abs_change_pct(at_the_joint, at_the_joint.lbs);

TEST(PrintedEquations, DerivedFormReducesTheErrorOfLbs)
{
    const Finding derived = run(at_the_joint, VolumeForm::derived);
    RecordProperty("lbs_pct", std::to_string(lbs_pct));
    RecordProperty("derived_pct", std::to_string(derived.change_pct));
    EXPECT_LT(derived.change_pct, 0.5 * lbs_pct);
}

TEST(PrintedEquations, LabelsMakeItWorseThanLbs)
{
    const Finding labels = run(at_the_joint, VolumeForm::labels_relative);
    RecordProperty("labels_relative_pct", std::to_string(labels.change_pct));
    EXPECT_GT(labels.change_pct, 2.0 * lbs_pct);
}

TEST(PrintedEquations, AbsolutePositionsDependOnTheOrigin)
{
    const double here = run(at_the_joint, VolumeForm::labels_absolute).change_pct;
    const double there = run(a_metre_away, VolumeForm::labels_absolute).change_pct;
    RecordProperty("labels_absolute_at_the_joint_pct", std::to_string(here));
    RecordProperty("labels_absolute_a_metre_away_pct", std::to_string(there));
    EXPECT_GT(std::abs(here - there), 0.2 * lbs_pct);
    EXPECT_GT(std::min(here, there), run(at_the_joint, VolumeForm::derived).change_pct);
    // Inverted tets propagate the rounding of f32; a fifth is far below the factor of two between the origins.
    EXPECT_NEAR(run(at_the_joint, VolumeForm::labels_absolute, pbs::Precision::f32).change_pct / here, 1.0, 0.2);
    EXPECT_NEAR(run(a_metre_away, VolumeForm::labels_absolute, pbs::Precision::f32).change_pct / there, 1.0, 0.2);
}

// Equal up to rounding, which the tets inverted by LBS propagate; a twentieth of a per cent is far below the difference
// between the forms.
TEST(PrintedEquations, DerivedFormDoesNotDependOnTheOrigin)
{
    EXPECT_NEAR(run(a_metre_away, VolumeForm::derived).change_pct, run(at_the_joint, VolumeForm::derived).change_pct,
                0.05);
}

TEST(PrintedEquations, SignBlowsUp)
{
    const Finding sign = run(at_the_joint, VolumeForm::sign);
    RecordProperty("sign_pct", std::to_string(sign.change_pct));
    EXPECT_TRUE(sign.outcome == Outcome::not_finite || sign.change_pct > 1000.0) << sign.change_pct;
}

TEST(PrintedEquations, AllErrorsTogetherAreWorseThanLbs)
{
    const Finding printed = run(at_the_joint, VolumeForm::as_printed);
    RecordProperty("as_printed_pct", std::to_string(printed.change_pct));
    EXPECT_FALSE(printed.change_pct <= lbs_pct) << printed.change_pct;  // larger, or not a number
}

}  // namespace
