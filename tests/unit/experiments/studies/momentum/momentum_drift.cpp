// Truth: Eq. 3-4 and the definition of the drift. A class that conserves has a drift of rounding; one force alone has 1.
#include "experiments/studies/momentum/momentum_drift.hpp"

#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::drift_of_a_pass;
using experiments::drift_of_projections;
using experiments::ProjectedClass;
using pbs::Masses;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);

pbs::PbsOptions in_double(Masses masses)
{
    pbs::PbsOptions options;
    options.precision = pbs::Precision::f64;
    options.masses = masses;
    return options;
}

// Corrections of some 1e-2 m to coordinates of 1 m: a hundred roundings each, some 1e-14 over 1e-2.
constexpr double rounding = 1e-11;

TEST(MomentumDrift, OfStretchAndVolumeIsRounding)
{
    for (const Masses masses : {Masses::unit, Masses::lumped})
        for (const ProjectedClass projected : {ProjectedClass::stretch, ProjectedClass::volume}) {
            const auto drift = drift_of_projections(test_support::character_of(bent), bent.pose, in_double(masses), projected, masses);
            EXPECT_LT(drift.linear, rounding);
            EXPECT_LT(drift.angular, rounding);
            EXPECT_LT(drift_of_a_pass(test_support::character_of(bent), bent.pose, in_double(masses), projected, masses).linear, rounding);
        }
}

// To first order in the corrections: with a stiffness ten times smaller the drift is, per correction, ten times smaller.
TEST(MomentumDrift, OfAPassTurnsAtSecondOrder)
{
    const auto angular = [](double k_stretch) {
        pbs::PbsOptions options = in_double(Masses::unit);
        options.k_stretch = k_stretch;
        return drift_of_a_pass(test_support::character_of(bent), bent.pose, options, ProjectedClass::stretch, Masses::unit).angular;
    };
    EXPECT_GT(angular(0.1), rounding);
    EXPECT_NEAR(angular(1e-3) / angular(1e-2), 0.1, 0.02);
}

TEST(MomentumDrift, WithUnequalMassesThatTheProjectionDoesNotKnowIsNoRounding)
{
    const auto drift =
        drift_of_projections(test_support::character_of(bent), bent.pose, in_double(Masses::unit), ProjectedClass::stretch, Masses::lumped);
    EXPECT_GT(drift.linear, 1e-3);
}

TEST(MomentumDrift, OfBindIsTheBones)
{
    const auto drift =
        drift_of_a_pass(test_support::character_of(bent), bent.pose, in_double(Masses::unit), ProjectedClass::bind, Masses::unit);
    EXPECT_GT(drift.linear, 1e-3);
    EXPECT_LE(drift.linear, 1.0);
    EXPECT_LE(drift.angular, 1.0);
}

}  // namespace
