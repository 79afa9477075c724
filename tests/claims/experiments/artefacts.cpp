// C04, C05 and C06 are judged from the values that the study of artefacts writes: if the sections and strains behind them are altered, the
// verdicts change. Reference: the project's own claims.toml.

#include "experiments/studies/artefacts/artefact_values.hpp"
#include "tests/support/artefact_samples.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using namespace test_support;
using analysis::Measurement;
using analysis::VerdictKind;

class ArtefactsVerdict : public testing::Test {
protected:
    std::vector<Measurement> thin(const std::vector<ArtefactSample>& samples) const { return candy_wrapper_values(twisted, body, samples); }
    std::vector<Measurement> wide(const std::vector<ArtefactSample>& samples) const { return bulge_values(bent, body, samples); }

    ArtefactCase twisted = small_limb(ArtefactCase::Claim::candy_wrapper);
    ArtefactCase bent = small_limb(ArtefactCase::Claim::bulge);
    ArtefactBody body{bent};
};

// A section that is too thin, or too wide, in one order flips the verdict of the claim; in the default order it turns it.
TEST_F(ArtefactsVerdict, AThinSectionIsACandyWrapperAndAWideOneABulge)
{
    std::vector<ArtefactSample> samples = {sample("pbs", 0, 0.97), sample("pbs", 1, 0.98), sample("lbs", 0, 0.0), sample("dqs", 0, 1.0),
                                           sample("reference", 0, 1.0, 1)};
    expect_quantities_of("C04", thin(samples));
    EXPECT_EQ(verdict_on("C04", thin(samples)), VerdictKind::reproduced);
    samples.push_back(sample("pbs", 1, 0.5));  // in another order
    EXPECT_EQ(verdict_on("C04", thin(samples)), VerdictKind::reproduced_only_for);
    samples[0] = sample("pbs", 0, 0.3);
    EXPECT_EQ(verdict_on("C04", thin(samples)), VerdictKind::not_reproduced);
    EXPECT_EQ(verdict_on("C04", thin({sample("lbs", 0, 0.1)})), VerdictKind::not_computable) << "there is no value of PBS";

    samples = {sample("pbs", 0, 1.01), sample("pbs", 1, 1.02),         sample("dqs", 0, 2.0),
               sample("lbs", 0, 1.0),  sample("reference", 0, 1.0, 1), sample("reference", 1, 1.0, 1)};
    expect_quantities_of("C05", wide(samples));
    EXPECT_EQ(verdict_on("C05", wide(samples)), VerdictKind::reproduced);
    samples[1] = sample("pbs", 1, 1.2);
    EXPECT_EQ(verdict_on("C05", wide(samples)), VerdictKind::reproduced_only_for);
    samples[0] = sample("pbs", 0, 1.2);
    EXPECT_EQ(verdict_on("C05", wide(samples)), VerdictKind::not_reproduced);
    EXPECT_EQ(verdict_on("C05", wide({sample("pbs", 0, 1.0)})), VerdictKind::not_computable) << "there is no reference";
    for (const double wide_over_rest : {2.9, 3.1, 8.0})  // only pbs itself assigns the limb to another part
        EXPECT_EQ(verdict_on("C05", wide({sample("pbs", 0, wide_over_rest), sample("reference", 0, 1.0, 1)})), VerdictKind::not_reproduced)
            << wide_over_rest;
}

// The value of the body exceeds it, and its interval also covers linear elements.
TEST_F(ArtefactsVerdict, QuadraticElementsAreTheReference)
{
    std::vector<ArtefactSample> samples = {sample("pbs", 0, 1.0), sample("reference", 0, 1.0, 1)};
    EXPECT_EQ(verdict_on("C05", wide(samples)), VerdictKind::reproduced);
    samples.push_back(sample("reference", 0, 0.8, 2));
    EXPECT_EQ(verdict_on("C05", wide(samples)), VerdictKind::not_reproduced);
    EXPECT_DOUBLE_EQ(wide(samples)[0].value, 1.25);
}

TEST_F(ArtefactsVerdict, ARatioAboveOneIsNotSmoother)
{
    bent.poses = {{2, "bend_60_deg"}};
    std::vector<Measurement> measured = compare_weights(bent).measurements;
    expect_quantities_of("C06", measured);
    const auto put = [&](const std::string& quantity, const analysis::CaseKey& of, double ratio) {
        for (Measurement& measurement : measured)
            if (measurement.quantity == quantity && analysis::matches(measurement.of, of))
                measurement.value = measurement.low = measurement.high = ratio;
    };
    put("strain_jump_over_rigid_weights", {}, 0.5);
    put("curvature_over_rigid_weights", {}, 9.0);  // reported only
    EXPECT_EQ(verdict_on("C06", measured), VerdictKind::reproduced);
    put("strain_jump_over_rigid_weights", {.deformer = "pbs"}, 1.1);
    EXPECT_EQ(verdict_on("C06", measured), VerdictKind::not_reproduced);
}

// C04 from a twisted limb, with the correct solver and with broken ones. Reference:
// - nothing projected: LBS remains, with radii down to cos 85 deg = 0.09 of the radius and less: a candy wrapper.
// - bind dropped: only bind constraints contain the distance from the bone, so at 170 degrees sections are narrower than with them.
// - volume sign: the volume projections undo the effect of the bind constraints, so sections are narrower.
// - volume or stretch dropped: the bind constraints still put every vertex at its distance, so the verdict stays at 90 degrees. There is no
//   theory for the effect of the remaining class on the skin between the vertices. At 170 degrees, where the verdict was also expected to
//   stay, sections fall below the bound, although they are far above those of LBS.

// Without other orders and meshes, which only affect the interval.
std::vector<Measurement> twisted(Broken how, const std::string& angle_deg = "170")
{
    const ArtefactCase of = twisted_limb(400, angle_deg, how);
    const ArtefactBody body(of);
    std::vector<ArtefactSample> samples;
    for (const DeformerSpec& spec : of.scene.deformers) {
        const Shape shape = body.posed.shapes(spec).at(0);
        samples.push_back({spec.kind, 0, 0, extremes_of(body.sections.at(0).measure(shape.positions, body.posed.pose(0)))});
    }
    return candy_wrapper_values(of, body, samples);
}

double smallest(const std::vector<Measurement>& measured, const std::string& what, const std::string& deformer = "pbs")
{
    return values_of(measured, "smallest_section_" + what, {.deformer = deformer}).at(0).value;
}

TEST(BrokenArtefacts, AsItIsThereIsNoCandyWrapper)
{
    const auto measured = twisted(Broken::nothing);
    EXPECT_EQ(verdict_on("C04", measured), VerdictKind::reproduced);
    EXPECT_LT(smallest(measured, "radius_over_rest", "lbs"), 0.5);  // there is an artefact to remove
}

TEST(BrokenArtefacts, NothingProjectedIsLbs)
{
    const auto measured = twisted(Broken::nothing_projected);
    EXPECT_EQ(verdict_on("C04", measured), VerdictKind::not_reproduced);
    // The solver rounds the positions of LBS to float.
    const ArtefactCase of = twisted_limb(400, "170");
    const ArtefactBody body(of);
    const pbs::Positions lbs = body.posed.shapes(spec_of(of.scene, "lbs")).at(0).positions;
    for (const auto& [what, size] : {std::pair{"radius_over_rest", &SectionExtremesOverRest::smallest_radius},
                                     {"area_over_rest", &SectionExtremesOverRest::smallest_area}}) {
        const auto value = [&, size = size](const pbs::Positions& positions) {
            return extremes_of(body.sections.at(0).measure(positions, body.posed.pose(0))).*size;
        };
        EXPECT_NEAR(smallest(measured, what), smallest(measured, what, "lbs"), value_rounding(lbs, single_rounding_m(lbs), value));
    }
}

TEST(BrokenArtefacts, WithoutBindOrWithTheSignTurnedRoundSectionsAreNarrower)
{
    for (const auto& [sound_how, how] :
         {std::pair(Broken::nothing, Broken::bind_dropped), {Broken::nothing_in_plain_order, Broken::volume_sign}}) {
        const auto sound = twisted(sound_how), measured = twisted(how);
        EXPECT_LT(smallest(measured, "radius_over_rest"), smallest(sound, "radius_over_rest")) << name_of(how);
        EXPECT_EQ(verdict_on("C04", sound), VerdictKind::reproduced) << name_of(sound_how);
        EXPECT_NE(verdict_on("C04", measured), VerdictKind::reproduced) << name_of(how);
        if (how == Broken::bind_dropped) {
            EXPECT_LT(smallest(measured, "area_over_rest"), smallest(sound, "area_over_rest"));
        }
    }
}

// Only without bind constraints, the candy wrapper returns: narrower than half of what remains without any other class.
TEST(BrokenArtefacts, WithoutVolumeOrStretchTheBindConstraintsStillHold)
{
    const auto sound = twisted(Broken::nothing);
    const double without_bind = smallest(twisted(Broken::bind_dropped), "radius_over_rest");
    for (const Broken how : {Broken::volume_dropped, Broken::stretch_dropped}) {
        EXPECT_EQ(verdict_on("C04", twisted(how, "90")), VerdictKind::reproduced) << name_of(how);
        const double radius = smallest(twisted(how), "radius_over_rest");
        EXPECT_LT(radius, smallest(sound, "radius_over_rest")) << name_of(how);
        EXPECT_GT(radius, 0.5) << name_of(how);  // half way from LBS
        EXPECT_LT(without_bind, 0.5 * radius) << name_of(how);
    }
}

}  // namespace
