// C04, C05 and C06 are judged from the values that the study of artefacts writes: if the sections and strains behind
// them are altered, the verdicts change. Reference: the project's own claims.toml.

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

// Five poses, the fewest cases of a verdict. PBS has the given sections; in each pose LBS is too thin, DQS too wide,
// and flesh as at rest.
class ArtefactsVerdict : public testing::Test {
protected:
    std::vector<ArtefactSample> samples_of(const std::vector<double>& pbs) const
    {
        std::vector<ArtefactSample> samples;
        for (std::size_t pose = 0; pose < twisted.poses.size(); ++pose)
            for (const auto& [group, size] :
                 {std::pair{"lbs", 0.5}, {"dqs", 1.5}, {"pbs_author", 1.0}, {"reference", 1.0}, {"nh_p2_nu_049", 1.0}})
                samples.push_back(sample(group, pose, size, group == std::string("reference")));
        for (std::size_t pose = 0; pose < pbs.size(); ++pose) samples.push_back(sample("pbs", pose, pbs[pose]));
        return samples;
    }
    std::vector<Measurement> thin(const std::vector<ArtefactSample>& samples) const
    {
        return section_values(twisted, body, samples);
    }
    std::vector<Measurement> wide(const std::vector<ArtefactSample>& samples) const
    {
        return section_values(bent, body, samples);
    }

    ArtefactCase twisted = small_limb(ArtefactCase::Claim::candy_wrapper, 20, {1, 2, 3, 4, 5});
    ArtefactCase bent = small_limb(ArtefactCase::Claim::bulge, 20, {1, 2, 3, 4, 5});
    ArtefactBody body{bent};
};

// A section that is too thin, or too wide, turns the verdict; in another order or on another mesh it does not.
TEST_F(ArtefactsVerdict, ThinSectionsAreACandyWrapper)
{
    std::vector<ArtefactSample> samples = samples_of({0.97, 0.97, 0.97, 0.97, 0.97});
    expect_values_of("C04", thin(samples));
    EXPECT_EQ(verdict_on("C04", thin(samples)), VerdictKind::holds);
    samples.push_back(sample("pbs", 1, 0.5, 0, "ordered"));
    samples.push_back(sample("pbs", 1, 0.4));
    EXPECT_EQ(verdict_on("C04", thin(samples)), VerdictKind::holds);
    EXPECT_EQ(own_cases("C04", thin(samples)).cases.at(1).low, 0.4);
    EXPECT_EQ(verdict_on("C04", thin(samples_of({0.97, 0.97, 0.97, 0.97, 0.3}))), VerdictKind::mixed);
    EXPECT_EQ(verdict_on("C04", thin(samples_of({0.97, 0.97, 0.3, 0.3, 0.3}))), VerdictKind::fails);
    EXPECT_EQ(verdict_on("C04", thin(samples_of({}))), VerdictKind::inconclusive) << "there is no value of PBS";
}

TEST_F(ArtefactsVerdict, SectionsThinnerThanThoseOfFleshAreACandyWrapper)
{
    const std::vector<double> half(5, 0.5);
    std::vector<ArtefactSample> samples = samples_of(half);
    EXPECT_EQ(own_cases("C04", thin(samples)).held, 0);
    for (ArtefactSample& one : samples)
        if (one.group == "reference") one.extremes.smallest_radius = 0.5;
    EXPECT_EQ(own_cases("C04", thin(samples)).held, 5);
    std::erase_if(samples, [](const ArtefactSample& one) { return one.group == "reference"; });
    EXPECT_EQ(own_cases("C04", thin(samples)).n, 0) << "there is no reference";
}

TEST_F(ArtefactsVerdict, WideSectionsAreABulge)
{
    std::vector<ArtefactSample> samples = samples_of({1.02, 1.02, 1.02, 1.02, 1.02});
    expect_values_of("C05", wide(samples));
    EXPECT_EQ(verdict_on("C05", wide(samples)), VerdictKind::holds);
    // beyond 3, only PBS itself assigns the limb to another part
    for (const double wide_over_rest : {1.2, 2.9, 3.1, 8.0}) {
        EXPECT_EQ(verdict_on("C05", wide(samples_of({1.02, 1.02, 1.02, 1.02, wide_over_rest}))), VerdictKind::mixed)
            << wide_over_rest;
        EXPECT_EQ(verdict_on("C05", wide(samples_of(std::vector(5, wide_over_rest)))), VerdictKind::fails)
            << wide_over_rest;
    }
    std::erase_if(samples, [](const ArtefactSample& one) { return one.group == "reference"; });
    EXPECT_EQ(verdict_on("C05", wide(samples)), VerdictKind::inconclusive) << "there is no reference";
}

// The value of the body exceeds it, and its range also covers linear elements.
TEST_F(ArtefactsVerdict, QuadraticElementsAreTheReference)
{
    std::vector<ArtefactSample> samples = {sample("pbs", 0, 1.0), sample("reference", 0, 1.0, 1)};
    EXPECT_EQ(own_cases("C05", wide(samples)).held, 1);
    samples.push_back(sample("reference", 0, 0.8, 2));
    EXPECT_EQ(own_cases("C05", wide(samples)).held, 0);
    EXPECT_DOUBLE_EQ(wide(samples)[0].value, 1.25);
}

// The values of one bent limb stand for those of seven bodies, the fewest that a coin hardly reaches.
TEST_F(ArtefactsVerdict, RatiosAboveOneAreNotSmoother)
{
    bent.poses = {{2, "bend_40_deg"}};
    std::vector<Measurement> measured;
    for (Measurement one : compare_weights(bent).measurements)
        for (const char* name : {"a", "b", "c", "d", "e", "f", "g"}) {
            one.of.body = name;
            measured.push_back(one);
        }
    expect_values_of("C06", measured);
    const auto put = [&](const std::string& quantity, const analysis::CaseKey& of, double ratio) {
        for (Measurement& measurement : measured)
            if (measurement.quantity == quantity && analysis::matches(measurement.of, of))
                measurement.value = measurement.low = measurement.high = ratio;
    };
    const std::string jump = "strain_jump_over_rigid_weights";
    const analysis::CaseKey own = {.deformer = "pbs", .variant = "default", .order = "plain", .precision = "f64"};
    put(jump, {}, 9.0);  // other orders and LBS are shown only
    put(jump, own, 0.5);
    put(jump, {.variant = "diffused_weights"}, 0.5);
    put("curvature_over_rigid_weights", {}, 9.0);  // shown only
    EXPECT_EQ(verdict_on("C06", measured), VerdictKind::holds);
    for (const char* name : {"a", "b", "c", "d"}) {
        analysis::CaseKey of = own;
        of.body = name;
        put(jump, of, 1.1);
    }
    EXPECT_EQ(verdict_on("C06", measured), VerdictKind::fails);
    put(jump, own, 0.5);
    put(jump, {.variant = "exchanged_weights"}, 0.5);
    EXPECT_EQ(verdict_on("C06", measured), VerdictKind::inconclusive) << "the bound cannot be missed";
}

// C04 from a twisted limb, with the correct solver and with broken ones. Reference:
// - nothing projected: LBS remains, with radii down to cos 85 deg = 0.09 of the radius and less: a candy wrapper.
// - bind dropped: only bind constraints contain the distance from the bone, so at 170 degrees sections are narrower
//   than with them.
// - volume sign: the volume projections undo the effect of the bind constraints, so sections are narrower.
// - volume or stretch dropped: the bind constraints still put every vertex at its distance, so the verdict stays at 60
//   degrees. There is no theory for the effect of the remaining class on the skin between the vertices. At 170 degrees,
//   where the verdict was also expected to stay, sections fall below the bound, although they are far above those of
//   LBS.

constexpr int vertices = 1200;  // on a coarser mesh, sections between the vertices narrow by themselves

// On one mesh. Flesh is taken to keep its sections; it narrows by 3 % when the limb is twisted by 180 degrees.
std::vector<Measurement> twisted(Broken how, const std::string& angle_deg = "170")
{
    const ArtefactCase of = twisted_limb(vertices, angle_deg, how);
    const ArtefactBody body(of);
    std::vector<ArtefactSample> samples = {sample("reference", 0, 1.0, 1)};
    for (const DeformerSpec& spec : of.scene.deformers) {
        const Shape shape = body.posed.shapes(spec).at(0);
        samples.push_back(sample(spec.kind, 0, 0.0));
        samples.back().extremes = extremes_of(body.sections.at(0).measure(shape.positions, body.posed.pose(0)));
    }
    return section_values(of, body, samples);
}

double smallest(const std::vector<Measurement>& measured, const std::string& deformer = "pbs")
{
    return values_of(measured, "smallest_section_radius_over_rest", {.deformer = deformer}).at(0).value;
}

bool lies_within_bound(const std::vector<Measurement>& measured)
{
    return own_cases("C04", measured).cases.at(0).holds;
}

TEST(BrokenArtefacts, AsItIsThereIsNoCandyWrapper)
{
    const auto measured = twisted(Broken::nothing);
    EXPECT_TRUE(lies_within_bound(measured)) << smallest(measured);
    EXPECT_LT(smallest(measured, "lbs"), 0.5);  // there is an artefact to remove
}

TEST(BrokenArtefacts, NothingProjectedIsLbs)
{
    const auto measured = twisted(Broken::nothing_projected);
    EXPECT_FALSE(lies_within_bound(measured));
    // Positions go through 24 roundings of two motions, on both sides.
    const ArtefactCase of = twisted_limb(vertices, "170");
    const ArtefactBody body(of);
    const pbs::Positions lbs = body.posed.shapes(spec_of(of.scene, "lbs")).at(0).positions;
    const auto value = [&](const pbs::Positions& positions) {
        return extremes_of(body.sections.at(0).measure(positions, body.posed.pose(0))).smallest_radius;
    };
    EXPECT_NEAR(smallest(measured), smallest(measured, "lbs"),
                value_rounding(lbs, coordinate_rounding_m(lbs, 2 * 24), value));
}

TEST(BrokenArtefacts, WithoutBindOrWithTheSignTurnedRoundSectionsAreNarrower)
{
    const double sound = smallest(twisted(Broken::nothing));
    for (const Broken how : {Broken::bind_dropped, Broken::volume_sign}) {
        const auto measured = twisted(how);
        EXPECT_LT(smallest(measured), sound) << name_of(how);
        EXPECT_FALSE(lies_within_bound(measured)) << name_of(how);
    }
}

// Only without bind constraints, the candy wrapper returns: narrower than half of what remains without any other class.
TEST(BrokenArtefacts, WithoutVolumeOrStretchTheBindConstraintsStillHold)
{
    const double sound = smallest(twisted(Broken::nothing)), without_bind = smallest(twisted(Broken::bind_dropped));
    for (const Broken how : {Broken::volume_dropped, Broken::stretch_dropped}) {
        EXPECT_TRUE(lies_within_bound(twisted(how, "60"))) << name_of(how);
        const double radius = smallest(twisted(how));
        EXPECT_LT(radius, sound) << name_of(how);
        EXPECT_GT(radius, 0.5) << name_of(how);  // half way from LBS
        EXPECT_LT(without_bind, 0.5 * radius) << name_of(how);
    }
}

}  // namespace
