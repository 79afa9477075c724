// C07 from correct and broken projections. Reference:
// - volume sign: corrections are reversed and still add up to zero, so the verdict must stay (Eq. 3-4 require no more).
// - printed labels: gradients at the wrong particles still add up to zero (Eq. 15), but their moments do not: angular
// momentum is lost,
//   linear momentum is not.
// - a class dropped: a class that is not projected has no drift, so it is not counted as conserved.
// A case is a class and linear or angular momentum.
#include "experiments/studies/momentum/momentum_drift.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/momentum_rounding.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

namespace momentum_tests {
namespace {

using namespace experiments;
using namespace test_support;

using analysis::Measurement;
using pbs::Masses;

pbs::PbsOptions in_double()
{
    pbs::PbsOptions options;
    options.precision = pbs::Precision::f64;
    options.order = pbs::Order::plain;
    return options;
}

const TwoBoneLimb& limb()
{
    static const TwoBoneLimb limb = two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);
    return limb;
}

DriftRounding rounding_of(ProjectedClass projected)
{
    return drift_rounding(character_of(limb()), limb().pose, in_double(), projected);
}

// Single projections and a pass, with equal masses, as in the study.
std::vector<Measurement> drifts(const pbs::PbsOptions& options)
{
    const pbs::Character character = character_of(limb());
    std::vector<Measurement> measured;
    const auto add = [&](const char* direction, const char* quantity, const char* of, double drift) {
        const analysis::CaseKey key = {.body = "limb", .precision = "f64", .masses = "equal", .constraint = of};
        measured.push_back({"C07", std::string(direction) + "_drift" + quantity, key, drift, drift, drift, "1"});
    };
    for (const auto& [projected, name] :
         {std::pair{ProjectedClass::stretch, "stretch"}, {ProjectedClass::volume, "volume"}})
        for (const auto& [measure, quantity] :
             {std::pair{&drift_of_projections, ""}, {&drift_of_a_pass, "_of_a_pass"}}) {
            const MomentumDrift drift = measure(character, limb().pose, options, projected, Masses::unit);
            add("linear", quantity, name, drift.linear);
            add("angular", quantity, name, drift.angular);
        }
    return measured;
}

// The cases that hold, by class and quantity, from single projections: a pass conserves angular momentum only to first
// order.
std::vector<std::string> conserved(const std::vector<Measurement>& measured)
{
    std::vector<std::string> held;
    for (const analysis::JudgedCase& of : judged(claim("C07"), claim("C07").own, measured).cases)
        if (of.holds) held.push_back(of.of.constraint + " " + of.quantity);
    return held;
}

using Cases = std::vector<std::string>;
const Cases of_stretch = {"stretch linear_drift", "stretch angular_drift"};
const Cases of_both = {"stretch linear_drift", "stretch angular_drift", "volume linear_drift", "volume angular_drift"};

double drift(const std::vector<Measurement>& measured, const std::string& quantity, const std::string& of)
{
    return values_of(measured, quantity, {.constraint = of}).at(0).value;
}

TEST(BrokenMomentum, TheSignTurnedRoundConservesAsWell)
{
    const auto sound = drifts(in_double()), turned = drifts(broken(in_double(), Broken::volume_sign));
    EXPECT_EQ(conserved(sound), of_both);
    EXPECT_EQ(conserved(turned), of_both);
    // the sign is reversed
    EXPECT_NE(drift(turned, "angular_drift_of_a_pass", "volume"), drift(sound, "angular_drift_of_a_pass", "volume"));
    const auto rounding = rounding_of(ProjectedClass::volume);  // corrections of the other sign are as large
    for (const auto& measured : {sound, turned}) {
        EXPECT_LT(drift(measured, "linear_drift", "volume"), rounding.linear);
        EXPECT_LT(drift(measured, "angular_drift", "volume"), rounding.angular);
    }
}

TEST(BrokenMomentum, GradientsUnderTheWrongParticlesLoseAngularMomentum)
{
    pbs::PbsOptions options = in_double();
    options.volume_form = pbs::VolumeForm::labels_relative;
    const auto wrong = drifts(options);
    // Three labels of four are wrong, and so are the corrections; they are not smaller than the right ones.
    for (const auto& [projected, name] :
         {std::pair{ProjectedClass::stretch, "stretch"}, {ProjectedClass::volume, "volume"}}) {
        EXPECT_LT(drift(wrong, "linear_drift", name), rounding_of(projected).linear);
        EXPECT_LT(drift(wrong, "linear_drift_of_a_pass", name), rounding_of(projected).of_a_pass);
    }
    for (const char* quantity : {"angular_drift", "angular_drift_of_a_pass"})
        EXPECT_GT(drift(wrong, quantity, "volume"), 0.01) << quantity;  // no rounding
    EXPECT_EQ(conserved(wrong), (Cases{"stretch linear_drift", "stretch angular_drift", "volume linear_drift"}));
}

TEST(BrokenMomentum, AClassThatIsNotProjectedIsNotConserved)
{
    EXPECT_EQ(conserved(drifts(broken(in_double(), Broken::volume_dropped))), of_stretch);
    EXPECT_EQ(conserved(drifts(broken(in_double(), Broken::nothing_projected))), Cases{});
}

}  // namespace
}  // namespace momentum_tests
