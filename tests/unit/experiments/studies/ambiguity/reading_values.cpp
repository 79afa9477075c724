// What the studies measure of readings. Reference: the studies' own functions, called directly, and what a reading
// cannot change.

#include "analysis/verdicts/measurement.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/momentum/momentum_drift.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace reading_values_tests {
namespace {

using namespace experiments;
using analysis::Measurement;

const nlohmann::json bent_limb = {{"name", "limb_bend"},  {"quick_s", 1.0},
                                  {"scene", "limb_bend"}, {"body", "limb"},
                                  {"motion", "bend"},     {"overrides", {"character.vertices=400"}},
                                  {"frame", 18},          {"iterations", 60},
                                  {"jolt_steps", 60},     {"along", {1.0, 0.0, 0.0}}};

std::vector<ReadingValues> read(const std::string& study, const std::vector<Overrides>& readings,
                                const nlohmann::json& of = bent_limb)
{
    return std::ranges::find(studies(), study, &Study::name)->read(StudyCase("ambiguity", of, false), readings);
}

const Measurement& value(const ReadingValues& read, const std::string& quantity)
{
    const auto found = std::ranges::find(read.values, quantity, &Measurement::quantity);
    if (found == read.values.end()) throw std::runtime_error("no " + quantity);
    return *found;
}

int number_of(const ReadingValues& read, const std::string& quantity)
{
    return int(std::ranges::count(read.values, quantity, &Measurement::quantity));
}

// Three initial guesses by two tolerances, where at least one guess of a pair reaches them.
TEST(ReadingValues, OfStartsNameTheCaseAlike)
{
    const auto all = read("convergence", {{}, {"pbs.k_stretch=0.9"}});
    ASSERT_EQ(all.size(), 2u);
    EXPECT_GE(number_of(all[0], "iterations_over_lbs_guess"), 3);
    EXPECT_LE(number_of(all[0], "iterations_over_lbs_guess"), 6);
    EXPECT_EQ(value(all[0], "iterations_over_lbs_guess").of, value(all[1], "iterations_over_lbs_guess").of);
    ASSERT_EQ(all[0].left_out.size(), 1u);
    EXPECT_EQ(all[0].left_out[0].claim, "C12a");
    EXPECT_EQ(all[0].left_out[0].reason, "judged on characters alone");
}

TEST(ReadingValues, OfProjectionsAreTheMomentumStudysDrifts)
{
    const auto all = read("momentum", {{}, {"pbs.masses=lumped"}});
    const Scene scene = read_scene("limb_bend", {"character.vertices=400"});
    const PosedCharacter posed(scene, {18});
    const auto drift =
        drift_of_projections(posed.character(), posed.pose(0), options_of<pbs::PbsOptions>(spec_of(scene, "pbs")),
                             ProjectedClass::stretch, pbs::Masses::unit);
    EXPECT_EQ(value(all[0], "linear_drift").value, drift.linear);
    EXPECT_EQ(value(all[0], "angular_drift").value, drift.angular);
    EXPECT_NE(value(all[1], "linear_drift_of_a_pass").value, value(all[0], "linear_drift_of_a_pass").value);
    // The projection takes these masses into account.
    EXPECT_LE(value(all[1], "linear_drift").value, claim_named("C07").own.thresholds.at(1).high);
}

// In Algorithm 1 the next position depends on the last two alone, whatever the step, so half the step swings twice as
// fast, exactly. In the last reading LBS moves the flesh by the jolt beforehand, and a body that moves as a whole
// violates no constraint.
TEST(ReadingValues, OfJoltsHaveTheSameDampingInSubstepsAndNoSwingWhereTheFleshIsCarriedAlong)
{
    const auto all = read("jiggle", {{}, {"pbs.time_step_s=0.005"}, {"pbs.variant.lbs_entry=increment"}});
    EXPECT_EQ(value(all[0], "frequency_ratio_at_half_time_step").value, 2.0);
    // The series is the same one with twice the samples. The fit uses those until 2 % of the largest excursion remain,
    // so that the later ones change the value at rest, and by it the ratio, by less than 2 %. Frequencies or decays by
    // another step's time would double or halve it.
    const double ratio = value(all[0], "damping_ratio").value;
    EXPECT_NEAR(value(all[1], "damping_ratio").value, ratio, 0.02 * ratio);
    EXPECT_EQ(number_of(all[0], "damping_ratio"), 4);  // one per setting
    EXPECT_EQ(number_of(all[2], "damping_ratio"), 0);
    EXPECT_FALSE(all[2].broke_down);

    EXPECT_TRUE(all[0].left_out.empty());
    for (const char* quantity : {"frequency_ratio_at_half_time_step", "frequency_ratio_at_twice_iterations"})
        EXPECT_EQ(number_of(all[0], quantity), 1) << quantity;
}

// C04 has the smallest radius per pose and joint, and that of the reference, by which it is divided. A shape that is
// not finite has none.
TEST(ReadingValues, OfSectionsAreOnePerPoseBesideTheReferenceUnlessTheReadingBreaksDown)
{
    const nlohmann::json twisted = {
        {"name", "limb_twist"},
        {"quick_s", 1.0},
        {"scene", "limb_twist"},
        {"what", "twist"},
        {"step_deg", 45},
        {"poses", 2},
        {"overrides", {"character.vertices=400", R"(deformers.use=["lbs","pbs"])", "reference.name=lbs"}}};
    const auto all = read(
        "artefacts",
        {{}, {"skinning.weights=either_end"}, {"pbs.jiggle.k_stretch=0.1", "pbs.gravity_m_s2=[0,-1e308,0]"}}, twisted);
    for (const int i : {0, 1}) EXPECT_EQ(all[i].values.size(), 4u);
    for (int i = 0; i < 4; ++i) {
        const analysis::Measurement &own = all[0].values.at(i), &other = all[1].values.at(i);
        EXPECT_EQ(own.claim, "C04");
        EXPECT_EQ(own.of, other.of);
        EXPECT_EQ(own.value != other.value, own.of.deformer == "pbs");
    }
    EXPECT_FALSE(all[0].broke_down);
    EXPECT_TRUE(all[2].broke_down);
    EXPECT_EQ(all[2].values.size(), 2u);
    for (const analysis::Measurement& one : all[2].values) EXPECT_EQ(one.of.deformer, "reference");
}

}  // namespace
}  // namespace reading_values_tests
