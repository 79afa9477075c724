// Reference: the description in readings.hpp with invented values; for whole comparisons the study of momentum, called
// directly.
#include "experiments/studies/ambiguity/readings.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/studies/momentum/momentum_drift.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace readings_tests {
namespace {

using namespace experiments;

const Reading reading = {.place = "masses", .name = "B", .baseline = "A", .overrides = {}};

ClaimValue value(double value, bool holds, analysis::Limit limit = analysis::Limit::none)
{
    return {
        "C09a", "damping_ratio", {.of = {.body = "limb"}, .unit = "1", .value = value, .limit = limit, .holds = holds}};
}

TEST(ClaimChanges, StateWhetherTheVerdictFlipsOrWhichValueIsMissing)
{
    const std::vector<ClaimValue> none, holds = {value(0.5, true)}, holds_too = {value(0.75, true)},
                                        fails = {value(2.0, false)}, zero = {value(0.0, false)},
                                        bounded = {value(1.25, false, analysis::Limit::at_least)},
                                        unknown = {value(std::numeric_limits<double>::quiet_NaN(), false)};
    struct Row {
        const char* name;
        std::vector<ClaimValue> a, b;
        const char *holds, *flips, *reason;
        bool has_ratio;
    };
    const Row rows[] = {{"both hold", holds, holds_too, "yes yes", "no", "", true},
                        {"neither holds", fails, unknown, "no no", "no", "", true},
                        {"A alone holds", holds, fails, "yes no", "yes", "", true},
                        {"B alone holds", fails, holds, "no yes", "yes", "", true},
                        {"B is only bounded", holds, bounded, "yes no", "yes", "B: at_least", true},
                        {"both are only bounded", bounded, bounded, "no no", "no", "A: at_least; B: at_least", true},
                        {"not a number", holds, unknown, "yes no", "yes", "", true},
                        {"A is zero", zero, holds, "no yes", "yes", "", false},
                        {"A alone", holds, none, "yes ", "no_value", "B has no such value", false},
                        {"B alone", none, holds, " yes", "no_value", "A has no such value", false}};
    for (const Row& row : rows) {
        SCOPED_TRACE(row.name);
        const auto changes = claim_changes(reading, row.a, row.b);
        ASSERT_EQ(changes.size(), 1u);
        EXPECT_EQ(changes[0].holds_a + " " + changes[0].holds_b, row.holds);
        EXPECT_EQ(changes[0].verdict_flips, row.flips);
        EXPECT_EQ(changes[0].reason, row.reason);
        EXPECT_EQ(changes[0].change.has_value(), !row.a.empty() && !row.b.empty());
        EXPECT_EQ(changes[0].b_over_a.has_value(), row.has_ratio);
    }
    EXPECT_TRUE(claim_changes(reading, none, none).empty());
}

TEST(ClaimChanges, HoldBothValuesOfEachCase)
{
    const ClaimValue limb_a = value(0.5, true), limb_b = value(1.25, false);
    ClaimValue human = value(0.7, true);
    human.judged.of = {.body = "human"};
    const auto changes = claim_changes(reading, {limb_a, human}, {human, limb_b});
    ASSERT_EQ(changes.size(), 2u);
    EXPECT_EQ(changes[0].of.body, "limb");
    EXPECT_EQ(changes[0].place, "masses");
    EXPECT_EQ(changes[0].reading_a, "A");
    EXPECT_EQ(changes[0].reading_b, "B");
    EXPECT_EQ(changes[0].a, 0.5);
    EXPECT_EQ(changes[0].b, 1.25);
    EXPECT_EQ(changes[0].change, 0.75);
    EXPECT_EQ(changes[0].b_over_a, 2.5);
    EXPECT_EQ(changes[1].of.body, "human");
    EXPECT_EQ(changes[1].change, 0.0);
}

// Reference: claims.toml and the rule of analysis::judged.
TEST(ClaimValues, AreOnePerQuantityAndCaseInAnySettingOfTheSolver)
{
    const analysis::CaseKey jolted = {.body = "limb", .deformer = "pbs", .order = "ordered", .masses = "unit"};
    const auto of_jolt = claim_values({"C09a"}, {{"C09", "damping_ratio", jolted, 0.5, 0.5, 0.5, "1"},
                                                 {"C09", "last_share_of_peak", jolted, 0.25, 0.25, 0.25, "1"},
                                                 {"C09", "frequency_hz", jolted, 14.0, 14.0, 14.0, "Hz"}});
    ASSERT_EQ(of_jolt.size(), 2u);
    EXPECT_EQ(of_jolt[0].quantity, "damping_ratio");
    EXPECT_TRUE(of_jolt[0].judged.holds);
    EXPECT_FALSE(of_jolt[1].judged.holds);

    analysis::CaseKey guess = {.body = "limb",
                               .deformer = "pbs",
                               .order = "ordered",
                               .precision = "f32",
                               .k_stretch = 0.5,
                               .initial_guess = "rigid_bind",
                               .tolerance = "residual"};
    const auto of_guess = claim_values(
        {"C03"}, {{"C03", "iterations_over_lbs_guess", guess, 30.0, 30.0, 30.0, "1", "", analysis::Limit::at_least}});
    ASSERT_EQ(of_guess.size(), 1u);
    EXPECT_EQ(of_guess[0].judged.of, analysis::CaseKey{.body = "limb"}) << "k_stretch may be that of the reading";
    EXPECT_EQ(of_guess[0].judged.limit, analysis::Limit::at_least);

    const analysis::CaseKey clip = {.body = "human", .deformer = "pbs", .variant = "exponent", .iterations = 24.0};
    EXPECT_EQ(claim_values({"C02a"}, {{"C02", "share_of_frames_within_half_pct", clip, 0.5, 0.5, 0.5, "1"}}).size(),
              1u);
}

StudyCase limb(const nlohmann::json& further)
{
    nlohmann::json values = {
        {"name", "limb"}, {"quick_s", 1.0}, {"full_s", 1.0}, {"scene", "limb_bend"}, {"body", "limb"}};
    values.update(further);
    return {"ambiguity", values, false};
}

TEST(Readings, ChangeTheSceneOfTheirBaselineWhichComesBefore)
{
    const StudyCase all = limb({{"overrides", {"pbs.gravity_m_s2=[0,-9.81,0]"}}});
    std::map<std::string, nlohmann::json> scenes;
    for (const Reading& one : readings_of(all)) {
        const nlohmann::json scene = to_json(all.scene(one.overrides));
        EXPECT_EQ(one.place.empty(), one.name == one.baseline);
        if (!one.place.empty()) {
            EXPECT_NE(scene, scenes.at(one.baseline)) << one.name;
        }
        EXPECT_TRUE(scenes.emplace(one.name, scene).second) << one.name << " twice";
    }
    EXPECT_EQ(scenes.size(), 32u);
}

TEST(Readings, GoWithoutBaselinesAndPlaces)
{
    std::set<std::string> baselines, places;
    for (const Reading& one : readings_of(limb({{"without", {"jiggling_0.9", "masses"}}}))) {
        baselines.insert(one.baseline);
        places.insert(one.place);
    }
    EXPECT_EQ(baselines, std::set<std::string>{"as_the_scene"});
    EXPECT_EQ(places.size(), 10u);  // of them one is that of the baseline
    EXPECT_FALSE(places.contains("masses"));
}

std::vector<ClaimChange> compared(const StudyCase& study_case, const std::vector<Reading>& readings)
{
    const test_support::ScratchFolder folder;
    EXPECT_EQ(compare_readings(study_case, readings, folder.path().string()), "");
    return rows_of(claim_change_columns(), analysis::read_csv(folder / "ambiguity.csv"));
}

const Reading scenes_own = {.place = "", .name = "own", .baseline = "own", .overrides = {}};

TEST(ComparedReadings, HaveTheValuesThatTheStudyOfTheClaimMeasures)
{
    const Overrides either_end = {"skinning.weights=either_end"};
    const StudyCase bent = limb({{"overrides", {"character.vertices=400"}}, {"claims", {"C07"}}, {"frame", 18}});
    const auto changes = compared(bent, {scenes_own, {"n_joints", "either_end", "own", either_end}});
    ASSERT_EQ(changes.size(), 8u);  // linear and angular, stretch and volume, in both precisions
    const auto drift = [&](const Overrides& overrides) {
        const Scene scene = bent.scene(overrides);
        return drift_of_projections(PosedCharacter(scene, {18}).character(), PosedCharacter(scene, {18}).pose(0),
                                    options_of<pbs::PbsOptions>(spec_of(scene, "pbs")), ProjectedClass::stretch,
                                    pbs::Masses::unit);
    };
    const auto change = std::ranges::find_if(changes, [](const ClaimChange& one) {
        return one.quantity == "angular_drift" && one.of.constraint == "stretch" && one.of.precision == "f32";
    });
    ASSERT_NE(change, changes.end());
    EXPECT_EQ(change->a, drift({}).angular);
    EXPECT_EQ(change->b, drift(either_end).angular);
    EXPECT_NE(change->a, change->b);
}

// Eq. 2 moves the volume of LBS, and the stiffness that of PBS alone.
TEST(ComparedReadings, HaveTheValuesOfTheFramesOfAScene)
{
    const StudyCase walk("ambiguity",
                         {{"name", "walk"},
                          {"quick_s", 1.0},
                          {"full_s", 1.0},
                          {"scene", "human_01_01"},
                          {"body", "human"},
                          {"motion", "01_01"},
                          {"claims", {"C01", "C02a"}},
                          {"overrides",
                           {R"(deformers.use=["lbs","pbs"])", R"(reference.name="")", "motion.rate_hz=1.0",
                            "output.frames=[]", "output.frame_names=[]"}}},
                         false);
    try {
        walk.scene();
    } catch (const pbs::InputError& error) {
        GTEST_SKIP() << error.what();
    }
    const auto changes = compared(walk, {scenes_own, {"k_volume", "soft", "own", {"pbs.k_volume=0.5"}}});
    ASSERT_EQ(changes.size(), 2u);
    EXPECT_EQ(changes[0].claim, "C01");
    EXPECT_EQ(changes[0].change, 0.0);
    EXPECT_EQ(changes[1].claim, "C02a");
    EXPECT_EQ(changes[1].of.motion, "01_01");
    EXPECT_NE(changes[1].change, 0.0);
}

}  // namespace
}  // namespace readings_tests
