// C07 is judged from the momentum study's own values: if they are altered, the verdict changes. Reference: Newton's third law; projections
// with the masses of the momentum conserve it, and Eq. 8-9 for m = 1 on unequal masses do not.

#include "experiments/studies/momentum/momentum_drift.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/momentum_rounding.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using namespace test_support;
using analysis::VerdictKind;

const analysis::Records& records_of_limb()
{
    static const analysis::Records records = records_of(momentum_study().plan(false));
    return records;
}

TEST(MomentumVerdict, HoldsWhereMassesAreKnownAndTurnsWithItsFigures)
{
    const analysis::Verdict verdict = judge(claim("C07"), records_of_limb());
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced_only_for);
    ASSERT_EQ(verdict.subjects.size(), 3u);
    EXPECT_EQ(verdict.subjects[2].name, "unequal_by_eq_8_9");
    for (const auto& subject : verdict.subjects) EXPECT_EQ(subject.extent == analysis::Extent::none, subject.name == "unequal_by_eq_8_9");
    analysis::Records records = records_of_limb();
    for (const auto& [drift, kind] : {std::pair(1e-9, VerdictKind::reproduced), {0.1, VerdictKind::not_reproduced}}) {
        for (auto& measured : records.measurements) measured.value = measured.low = measured.high = drift;
        EXPECT_EQ(judge(claim("C07"), records).kind, kind) << drift;
    }
}

// C07 from correct and broken projections. Reference:
// - volume sign: corrections are reversed and still add up to zero, so the verdict must stay (Eq. 3-4 require no more).
// - printed labels: gradients at the wrong particles still add up to zero (Eq. 15), but their moments do not: angular momentum is lost,
//   linear momentum is not.
// - a class dropped: a class that is not projected has no drift, so it is not counted as conserved.

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
        const analysis::CaseKey key = {.body = "limb", .masses = "equal", .constraint = of};
        measured.push_back({"C07", std::string(direction) + "_drift" + quantity, key, drift, drift, drift, "1"});
    };
    for (const auto& [projected, name] : {std::pair{ProjectedClass::stretch, "stretch"}, {ProjectedClass::volume, "volume"}})
        for (const auto& [measure, quantity] : {std::pair{&drift_of_projections, ""}, {&drift_of_a_pass, "_of_a_pass"}}) {
            const MomentumDrift drift = measure(character, limb().pose, options, projected, Masses::unit);
            add("linear", quantity, name, drift.linear);
            add("angular", quantity, name, drift.angular);
        }
    return measured;
}

// A pass conserves angular momentum only to first order, so the verdict is based on single projections.
std::vector<Measurement> single(const std::vector<Measurement>& measured, const std::string& of)
{
    std::vector<Measurement> found;
    for (const Measurement& measurement : measured)
        if (!measurement.quantity.ends_with("_of_a_pass") && (of.empty() || measurement.of.constraint == of)) found.push_back(measurement);
    return found;
}

double drift(const std::vector<Measurement>& measured, const std::string& quantity, const std::string& of)
{
    return values_of(measured, quantity, {.constraint = of}).at(0).value;
}

TEST(BrokenMomentum, TheSignTurnedRoundConservesAsWell)
{
    const auto sound = drifts(in_double()), turned = drifts(broken(in_double(), Broken::volume_sign));
    EXPECT_EQ(verdict_on("C07", turned), verdict_on("C07", sound));
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
    const auto of_volume = rounding_of(ProjectedClass::volume), of_stretch = rounding_of(ProjectedClass::stretch);
    EXPECT_LT(drift(wrong, "linear_drift", "volume"), of_volume.linear);
    EXPECT_LT(drift(wrong, "linear_drift", "stretch"), of_stretch.linear);
    EXPECT_LT(drift(wrong, "linear_drift_of_a_pass", "volume"), of_volume.of_a_pass);
    EXPECT_LT(drift(wrong, "linear_drift_of_a_pass", "stretch"), of_stretch.of_a_pass);
    for (const char* quantity : {"angular_drift", "angular_drift_of_a_pass"})
        EXPECT_GT(drift(wrong, quantity, "volume"), 0.01) << quantity;  // no rounding
    EXPECT_EQ(verdict_on("C07", single(drifts(in_double()), "")), VerdictKind::reproduced);
    EXPECT_EQ(verdict_on("C07", single(wrong, "")), VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict_on("C07", single(wrong, "volume")), VerdictKind::not_reproduced);
}

TEST(BrokenMomentum, AClassThatIsNotProjectedIsNotConserved)
{
    const auto dropped = drifts(broken(in_double(), Broken::volume_dropped));
    EXPECT_EQ(verdict_on("C07", single(dropped, "")), VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict_on("C07", single(drifts(broken(in_double(), Broken::nothing_projected)), "")), VerdictKind::not_reproduced);
}

}  // namespace
