// Reference: Eq. 3-4 and the definition of the drift. A class that conserves has a drift of rounding; one force alone
// has 1.
#include "experiments/studies/momentum/momentum_drift.hpp"

#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/constraints/volume.hpp"
#include "pbs/solver/constraint_set.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/momentum_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using pbs::Masses;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);
const pbs::Character character = test_support::character_of(bent);

pbs::PbsOptions in_double(Masses masses)
{
    pbs::PbsOptions options;
    options.precision = pbs::Precision::f64;
    options.masses = masses;
    return options;
}

TEST(MomentumDrift, OfStretchAndVolumeIsRounding)
{
    for (const Masses masses : {Masses::unit, Masses::lumped})
        for (const ProjectedClass projected : {ProjectedClass::stretch, ProjectedClass::volume}) {
            const auto drift = drift_of_projections(character, bent.pose, in_double(masses), projected, masses);
            const auto rounding = test_support::drift_rounding(character, bent.pose, in_double(masses), projected);
            EXPECT_LT(drift.linear, rounding.linear);
            EXPECT_LT(drift.angular, rounding.angular);
            EXPECT_LT(drift_of_a_pass(character, bent.pose, in_double(masses), projected, masses).linear,
                      rounding.of_a_pass);
        }
}

// The sums of the definition, over projections of positions that are in f32 before the first one begins: a correction
// is the difference of two f32 numbers. This program is compiled without vectorisation, the study with it.
TEST(MomentumDrift, OfAVolumeProjectionInF32StartsFromTheRoundedPosition)
{
    pbs::PbsOptions options = in_double(Masses::unit);
    options.precision = pbs::Precision::f32;
    const auto set = pbs::make_constraint_set<float>(character.mesh, character.binding.distance, {}, options);
    const pbs::Positions lbs = blended(character, bent.pose);
    const pbs::Vec3 centre = lbs.colwise().mean();
    const Eigen::MatrixX3f rounded = (lbs.rowwise() - centre.transpose()).cast<float>();
    double linear = 0.0, sum = 0.0;
    for (const auto& tet : set.volume) {
        std::array<Eigen::Vector3f, 4> p;
        for (int corner = 0; corner < 4; ++corner) p[corner] = rounded.row(tet.vertex[corner]);
        project(tet, 1.0f, 1.0f, 1.0f, 1.0f, p[0], p[1], p[2], p[3]);
        pbs::Vec3 own = pbs::Vec3::Zero();
        for (int corner = 0; corner < 4; ++corner) {
            const pbs::Vec3 correction =
                p[corner].cast<double>() - rounded.row(tet.vertex[corner]).transpose().cast<double>();
            own += correction;
            sum += correction.norm();
        }
        linear += own.norm();
    }
    ASSERT_GT(linear, 0.0);
    const auto drift = drift_of_projections(character, bent.pose, options, ProjectedClass::volume, Masses::unit);
    EXPECT_NEAR(drift.linear / (linear / sum), 1.0,
                test_support::rounding_error(2.0 * (4.0 * std::ssize(set.volume) + 10.0), 1.0));  // of sums in f64
}

// To first order in the corrections: with a stiffness ten times smaller the drift is, per correction, ten times
// smaller, up to terms of second order; a drift of order zero would not become smaller, and one of second order a
// hundred times.
TEST(MomentumDrift, OfAPassTurnsAtSecondOrder)
{
    const auto angular = [](double k_stretch) {
        pbs::PbsOptions options = in_double(Masses::unit);
        options.k_stretch = k_stretch;
        return drift_of_a_pass(character, bent.pose, options, ProjectedClass::stretch, Masses::unit).angular;
    };
    EXPECT_GT(angular(0.1), 1e-3);  // no rounding
    EXPECT_NEAR(angular(1e-3) / angular(1e-2), 0.1, 0.02);
}

// Neither is rounding, which is below 1e-10: unequal masses that the projection does not know, and the momentum that
// the bones take.
TEST(MomentumDrift, OfUnknownMassesAndOfBindIsNoRounding)
{
    const pbs::PbsOptions options = in_double(Masses::unit);
    EXPECT_GT(drift_of_projections(character, bent.pose, options, ProjectedClass::stretch, Masses::lumped).linear,
              1e-3);
    const auto of_bones = drift_of_a_pass(character, bent.pose, options, ProjectedClass::bind, Masses::unit);
    EXPECT_GT(of_bones.linear, 1e-3);
    EXPECT_LE(of_bones.linear, 1.0);
    EXPECT_LE(of_bones.angular, 1.0);
}

}  // namespace
