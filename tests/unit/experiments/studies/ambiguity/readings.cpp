// Reference: the description in readings.hpp, and how each claim's values are measured, with invented values; for
// scenes that move, the solver, LBS and the metrics, called directly, and the claims' own rules.

#include "experiments/studies/ambiguity/readings.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace readings_tests {
namespace {

using namespace experiments;

const Reading reading = {.place = "Eq. 2", .name = "B", .baseline = "A"};

JudgedValue value(double value, bool holds, analysis::Limit limit = analysis::Limit::none)
{
    return {"C09a", "damping_ratio", {.body = "limb"}, "1", "0.0001 to 1", value, holds, limit};
}

std::vector<ClaimChange> compared(const JudgedReading& a, const JudgedReading& b)
{
    return claim_changes("limb", "C09a", reading, a, b);
}

// A value that B lacks because it breaks down does not hold.
TEST(ClaimChanges, StateWhetherTheVerdictFlipsOrWhyThereIsNoValue)
{
    const std::vector<JudgedValue> none, holds = {value(0.5, true)}, holds_too = {value(0.6, true)},
                                         fails = {value(2.0, false)}, zero = {value(0.0, false)},
                                         bounded = {value(1.25, false, analysis::Limit::at_least)},
                                         unknown = {value(std::numeric_limits<double>::quiet_NaN(), false)};
    struct Row {
        const char* name;
        std::vector<JudgedValue> a, b;
        bool b_broke_down;
        const char *flips, *reason;
        bool has_b, has_ratio;
    };
    const Row rows[] = {{"within the bound", holds, holds_too, false, "no", "", true, true},
                        {"only a bound", holds, bounded, false, "yes", "B: at_least", true, true},
                        {"A alone", holds, none, false, "no_value", "B has no such value", false, false},
                        {"B alone", none, holds, false, "no_value", "A has no such value", true, false},
                        {"neither", none, none, false, "no_value", "neither reading has a value", false, false},
                        {"A held", holds, none, true, "yes", "B breaks down", false, false},
                        {"A failed", fails, none, true, "no", "B breaks down", false, false},
                        {"not a number", holds, unknown, true, "yes", "B breaks down", true, true},
                        {"nothing but the breakdown", none, none, true, "no_value", "B breaks down", false, false},
                        {"A is zero", zero, holds, false, "yes", "", true, false}};
    for (const Row& row : rows) {
        SCOPED_TRACE(row.name);
        const auto table = compared({row.a}, {row.b, row.b_broke_down});
        ASSERT_EQ(table.size(), 1u);
        EXPECT_EQ(table.at(0).verdict_flips, row.flips);
        EXPECT_EQ(table.at(0).reason, row.reason);
        EXPECT_EQ(table.at(0).b.has_value(), row.has_b);
        EXPECT_EQ(table.at(0).change.has_value(), !row.a.empty() && row.has_b);
        EXPECT_EQ(table.at(0).b_over_a.has_value(), row.has_ratio);
    }
}

TEST(ClaimChanges, OfAQuantityThatIsLeftOutHaveARowWithTheReason)
{
    const JudgedReading measured = {
        {value(0.5, true)}, false, {{"C09a", "share", "four settings"}, {"C12a", "other", "why"}}};
    const auto table = compared(measured, measured);
    ASSERT_EQ(table.size(), 2u);
    EXPECT_EQ(table.at(0).verdict_flips, "no");
    EXPECT_EQ(table.at(1).quantity, "share");
    EXPECT_EQ(table.at(1).verdict_flips, "no_value");
    EXPECT_EQ(table.at(1).reason, "four settings");
    EXPECT_FALSE(table.at(1).b.has_value());
}

TEST(ClaimChanges, HoldBothValuesOfEachCase)
{
    const JudgedValue limb_a = value(0.5, true), limb_b = value(1.25, false);
    JudgedValue human = value(0.7, true);
    human.of = {.body = "human"};
    const auto table = compared({{limb_a, human}}, {{human, limb_b}});
    ASSERT_EQ(table.size(), 2u);
    EXPECT_EQ(table.at(0).place, "Eq. 2");
    EXPECT_EQ(table.at(0).change, 0.75);
    EXPECT_EQ(table.at(0).b_over_a, 2.5);
    EXPECT_EQ(table.at(0).holds_a, "yes");
    EXPECT_EQ(table.at(0).holds_b, "no");
    EXPECT_EQ(table.at(1).change, 0.0);
}

// Reference: claims.toml and the rule of analysis::judged.

TEST(JudgedValue, IsTheUnitOfAClaimInAnySettingWithItsLimit)
{
    const analysis::CaseKey jolted = {.body = "limb", .deformer = "pbs", .masses = "lumped"};
    const auto values = judged({{"C09", "damping_ratio", jolted, 0.5, 0.5, 0.5, "1"},
                                {"C09", "frequency_hz", jolted, 14.0, 14.0, 14.0, "Hz"}});
    ASSERT_EQ(values.size(), 1u);
    EXPECT_EQ(values[0].claim, "C09a");
    EXPECT_EQ(values[0].quantity, "damping_ratio");
    EXPECT_TRUE(values[0].holds);
    EXPECT_FALSE(judged({{"C09", "damping_ratio", jolted, 2.0, 2.0, 2.0, "1"}})[0].holds);

    const analysis::CaseKey of = {
        .body = "limb", .order = "ordered", .precision = "f32", .initial_guess = "rigid_bind", .tolerance = "residual"};
    const auto bounded =
        judged({{"C03", "iterations_over_lbs_guess", of, 30.0, 30.0, 30.0, "1", "", analysis::Limit::at_least}});
    ASSERT_EQ(bounded.size(), 1u);
    EXPECT_EQ(bounded[0].of.body, "limb");
    EXPECT_EQ(bounded[0].limit, analysis::Limit::at_least);
}

TEST(JudgedValue, LeavesOutWhatIsNotMeasuredAndRefusesAnUnknownClaim)
{
    EXPECT_THROW(claim_named("C99"), std::logic_error);
    const auto left_out = all_but("C12a", {}, "why");
    ASSERT_EQ(left_out.size(), 1u);
    EXPECT_EQ(left_out[0].quantity, "iterations_to_tolerance");
    EXPECT_TRUE(all_but("C12a", {"iterations_to_tolerance"}, "why").empty());
}

TEST(DigestOfClaims, IsAnotherWithAnotherBoundAndTheSameWithOtherWords)
{
    const analysis::Claim claim = claim_named("C09a");
    const std::string digest = digest_of({claim});
    const auto changed = [&](const auto& change) {
        analysis::Claim other = claim;
        change(other);
        return digest_of({other});
    };
    EXPECT_NE(changed([](auto& c) { c.own.thresholds.at(0).low -= 1e-3; }), digest);
    EXPECT_NE(changed([](auto& c) { c.own.thresholds.pop_back(); }), digest);
    EXPECT_NE(changed([](auto& c) { c.own.of.masses = "lumped"; }), digest);
    EXPECT_NE(changed([](auto& c) { c.own.quantities.pop_back(); }), digest);
    EXPECT_NE(changed([](auto& c) { c.case_fields.pop_back(); }), digest);
    EXPECT_EQ(changed([](auto& c) { c.statement += "!"; }), digest);
    EXPECT_NE(digest_of({claim, claim_named("C10a")}), digest);
}

// Reference: an invented measurement that counts its calls.

std::vector<Reading> readings()
{
    const auto with = [](const std::string& place, const std::string& name, const nlohmann::json& settings) {
        return Reading{.place = place, .name = name, .baseline = "own", .settings = settings};
    };
    return {with("", "own", {{"masses", "unit"}, {"k_volume", 1.0}}),
            with("a place", "lumped", {{"masses", "lumped"}, {"k_volume", 1.0}}),
            with("a place", "softer", {{"masses", "unit"}, {"k_volume", 0.5}})};
}

TEST(ReadingComparison, MeasuresWhatTouchesTheClaimAndItsBaselineOnce)
{
    ReadingComparison comparison{"limb", readings()};
    std::vector<std::string> measured;
    comparison.measure({"C10a"}, [&](const std::vector<Reading>& touching) {
        std::vector<JudgedReading> values;
        for (const Reading& reading : touching) {
            measured.push_back(reading.name);
            const double ms = reading.name == "own" ? 2.0 : 3.0;
            values.push_back({{{"C10a", "ms", {.body = "limb"}, "ms", "", ms, true}}, false});
        }
        return values;
    });
    EXPECT_EQ(measured, (std::vector<std::string>{"own", "lumped"}));
    ASSERT_EQ(comparison.changes.size(), 2u);
    EXPECT_EQ(comparison.changes[0].b_over_a, 1.5);
    EXPECT_EQ(comparison.changes[1].verdict_flips, "not_touched");
    EXPECT_EQ(comparison.changes[1].reason, "another factor is no more work");
    EXPECT_TRUE(comparison.breakdown.empty());
}

TEST(ReadingComparison, SaysWhichReadingBreaksDown)
{
    ReadingComparison comparison{"limb", readings()};
    comparison.measure({"C10a"}, [](const std::vector<Reading>& touching) {
        return std::vector<JudgedReading>(touching.size(), JudgedReading{{}, true});
    });
    EXPECT_NE(comparison.breakdown.find("lumped (C10a)"), std::string::npos);
    EXPECT_EQ(comparison.changes.at(0).reason, "B breaks down");
}

// A reading belongs to a place and differs from its baseline, which comes before it.

const StudyCase limb(
    "ambiguity",
    {{"name", "limb"}, {"quick_s", 1.0}, {"scene", "limb_bend"}, {"overrides", {"pbs.gravity_m_s2=[0,-9.81,0]"}}},
    false);

const Reading& named(const std::vector<Reading>& all, const std::string& name)
{
    const auto found = std::ranges::find(all, name, &Reading::name);
    if (found == all.end()) throw std::out_of_range(name);
    return *found;
}

TEST(Readings, DifferFromTheirBaselineWhichComesBeforeAndThoseOfAStepRememberNothing)
{
    for (const char* which : {"all", "of_a_step", "of_motion"}) {
        SCOPED_TRACE(which);
        const std::vector<Reading> readings = readings_of(limb, which);
        std::vector<std::string> names;
        for (const Reading& reading : readings) {
            EXPECT_EQ(std::ranges::count(names, reading.name), 0) << reading.name;
            names.push_back(reading.name);
            ASSERT_EQ(std::ranges::count(names, reading.baseline), 1) << reading.name;
            EXPECT_EQ(reading.place.empty(), reading.name == reading.baseline);
            if (!reading.place.empty()) {
                EXPECT_NE(reading.settings, named(readings, reading.baseline).settings) << reading.name;
            }
        }
    }
    EXPECT_EQ(readings_of(limb, "all").size() + 1,
              readings_of(limb, "of_a_step").size() + readings_of(limb, "of_motion").size());
    for (const Reading& reading : readings_of(limb, "of_a_step")) {
        EXPECT_FALSE(reading.jiggles()) << reading.name;
        EXPECT_EQ(reading.settings.at("lbs_entry"), "start") << reading.name;
    }
}

TEST(Untouched, IsAClaimWhoseValuesAReadingCannotChange)
{
    const std::vector<Reading> readings = readings_of(limb, "all");
    struct Row {
        const char* reading;
        std::vector<std::string> touched, untouched;
    };
    const Row rows[] = {{"k_stretch_0.9", {"C02a", "C03", "C07", "C09a"}, {"C01", "C10a"}},
                        {"bones_at_either_end", {"C01", "C04", "C07", "C10a"}, {"C09a"}},
                        {"k_bind_0.5", {"C02a", "C09a"}, {"C07", "C10a"}},
                        {"reprojected", {"C04", "C10a"}, {"C07", "C09a"}},
                        {"volume_bind_stretch", {"C10a", "C12a"}, {"C07"}},
                        {"lumped", {"C07", "C09a", "C10a"}, {"C01"}},
                        {"increment", {"C04", "C05", "C09a", "C10a"}, {"C01", "C03", "C07", "C12a"}},
                        {"increment_without_gravity", {"C04"}, {"C03", "C07", "C12a"}},
                        {"by_bone", {"C02a", "C09a", "C10a"}, {"C03", "C04", "C05", "C07", "C12a"}},
                        {"without_gravity", {"C02a"}, {"C09a", "C10a", "C07"}},
                        {"substeps_2", {"C09a", "C10a"}, {"C03", "C04"}},
                        // A stiffness of zero leaves a class out, which is less work.
                        {"k_stretch_0.6_in_zone", {"C09a"}, {"C10a"}},
                        {"k_bind_0.5_in_zone", {"C09a"}, {"C10a"}},
                        {"k_bind_0_in_zone", {"C09a", "C10a"}, {}}};
    for (const auto& [name, touched, untouched] : rows) {
        const Reading& reading = named(readings, name);
        const auto reason = [&](const std::string& claim) {
            return untouched_because(claim, reading, named(readings, reading.baseline));
        };
        for (const std::string& claim : touched) EXPECT_EQ(reason(claim), "") << name << " " << claim;
        for (const std::string& claim : untouched) EXPECT_NE(reason(claim), "") << name << " " << claim;
        EXPECT_EQ(untouched_because("C02a", reading, reading), "the scene is so by itself");
    }
}

const test_support::TwoBoneLimb bar = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);
const pbs::Character character = test_support::character_of(bar);

ReadMotion bending(const pbs::Character& character, const Overrides& overrides, int frames = 4)
{
    Overrides all = {"motion.angle_deg=60", "motion.frames=" + std::to_string(frames), "motion.axis=[0,0,1]",
                     "pbs.k_stretch=0.2"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    return move(character, read_scene("limb_bend", all));
}

TEST(ReadMotion, OfTheScenesOwnReadingIsTheSolvers)
{
    const ReadMotion moved = bending(character, {});
    ASSERT_EQ(moved.shapes.size(), 4u);
    const pbs::Pose pose = pbs::joint_sweep(bar.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 4, 0.01).steps[2];
    pbs::Positions lbs;
    pbs::BlendSkinning<double>(bar.mesh.rest, bar.weights).linear(pose, lbs);
    pbs::PbsSolver solver(bar.mesh, bar.binding.distance, {}, {});
    solver.advance(lbs, pbs::posed_bind_points(bar.binding, pose), 0.01);
    EXPECT_EQ(moved.shapes[2], solver.positions());
    const analysis::MeshMetrics mesh_metrics(bar.mesh.rest, bar.mesh.tets);
    EXPECT_EQ(moved.pbs.volume_change_pct[2], mesh_metrics.measure(solver.positions()).volume_change_pct);
    EXPECT_EQ(moved.lbs.volume_change_pct[2], mesh_metrics.measure(lbs).volume_change_pct);
    EXPECT_EQ(moved.pbs.angle_deg, (std::vector<double>{0.0, 20.0, 40.0, 60.0}));
    EXPECT_TRUE(moved.finite);
}

TEST(ReadMotion, ByIncrementDependsOnThePathAndByStartDoesNot)
{
    const Overrides increment = {"pbs.variant.lbs_entry=increment"};
    EXPECT_EQ(bending(character, {}).shapes.back(), bending(character, {}, 2).shapes.back());
    EXPECT_NE(bending(character, increment).shapes.back(), bending(character, increment, 2).shapes.back());
}

// The bones touch only in the middle, so near the outer ends either_end blends where nearest_end does not.
TEST(ReadMotion, EitherEndMovesWhatEqTwoLeavesToOneBone)
{
    const pbs::Character other = reweighted(character, read_scene("limb_bend", {"skinning.weights=either_end"}));
    const ReadMotion nearest = bending(character, {}), either = bending(other, {});
    EXPECT_EQ(nearest.lbs.volume_change_pct[0], either.lbs.volume_change_pct[0]);  // at rest
    EXPECT_NE(nearest.lbs.volume_change_pct[3], either.lbs.volume_change_pct[3]);
    EXPECT_EQ(reweighted(character, read_scene("limb_bend", {})).weights.weight, character.weights.weight);
}

TEST(ReadMotion, BindPointsAndTheZoneAreThoseOfTheOptions)
{
    EXPECT_NE(bending(character, {"pbs.variant.bind_point=reprojected"}).shapes[3], bending(character, {}).shapes[3]);
    const Overrides falling = {"pbs.jiggle.zone_mean=of_bone", "pbs.gravity_m_s2=[0,-9.81,0]"};
    const ReadMotion moved = bending(character, falling, 2);
    pbs::PbsOptions options;
    options.jiggle = pbs::Jiggle{};
    options.gravity_m_s2 = {0.0, -9.81, 0.0};
    pbs::PbsSolver solver(bar.mesh, bar.binding.distance, pbs::jiggle_zone_by_bone(bar.binding), options);
    solver.advance(bar.mesh.rest, bar.binding.rest_point, 0.01);
    EXPECT_EQ(moved.shapes.at(0), solver.positions());
}

// The definitions of the values of volume.

// A clip of 100 frames with one vertex at x [m].
ReadMotion motion_of(double change_pct, double x)
{
    ReadMotion moved;
    for (auto* record : {&moved.pbs, &moved.lbs}) {
        record->scene = "walk";
        for (int frame = 0; frame < 100; ++frame) {
            record->frame.push_back(frame);
            record->time_s.push_back(0.2 * frame);
            record->volume_change_pct.push_back(change_pct);
            record->volume_abs_change_pct.push_back(2.0 * std::abs(change_pct));
            record->inverted_tets.push_back(0.0);
        }
    }
    moved.pbs.deformer = "pbs";
    moved.pbs.iterations = 24;
    moved.lbs.deformer = "lbs";
    for (int frame = 0; frame < 100; ++frame) moved.shapes.push_back((pbs::Positions(1, 3) << x, 0, 0).finished());
    return moved;
}

std::vector<VolumeChange> compared(const ReadMotion& a, const ReadMotion& b)
{
    return volume_changes("walk", Reading{.place = "Eq. 2", .name = "B", .baseline = "A"}, a, b, a, {});
}

const VolumeChange& change_of(const std::vector<VolumeChange>& rows, const std::string& name)
{
    const auto found = std::ranges::find(rows, name, &VolumeChange::quantity);
    if (found == rows.end()) throw std::runtime_error("no " + name);
    return *found;
}

TEST(VolumeChanges, HaveTheValuesOfBothAndTheirChange)
{
    const auto rows = compared(motion_of(-0.25, 0.0), motion_of(-0.75, 0.5));
    EXPECT_EQ(change_of(rows, "mean_volume_change_pct").a, -0.25);
    EXPECT_EQ(change_of(rows, "mean_volume_change_pct").b, -0.75);
    EXPECT_EQ(change_of(rows, "mean_volume_change_pct").change, -0.5);
    EXPECT_EQ(change_of(rows, "mean_volume_abs_change_pct").b, 1.5);
    EXPECT_EQ(change_of(rows, "share_of_frames_within_printed").a, 1.0);
    EXPECT_EQ(change_of(rows, "share_of_frames_within_printed").b, 0.0);
    EXPECT_EQ(change_of(rows, "distance_of_b_from_a_rms_m").b, 0.5);
}

// Gravity acts only on integrated particles. If all are integrated, a huge weight leaves nothing finite; if none is, it
// has no effect.
TEST(FrameTimes, OfReadingsAreOneTimeEachAndStateABreakdown)
{
    const StudyCase of("ambiguity",
                       {{"name", "limb"},
                        {"quick_s", 1.0},
                        {"scene", "limb_bend"},
                        {"overrides", {"character.vertices=400", "pbs.gravity_m_s2=[0,-1e308,0]"}},
                        {"timing_s", 0.05}},
                       false);
    const auto all = values_of_frames(of, {{}, {"pbs.time_step_s=0.0025"}, {"pbs.variant.lbs_entry=increment"}});
    ASSERT_EQ(all.size(), 3u);
    for (const JudgedReading& read : all) {
        ASSERT_EQ(read.values.size(), 1u);
        EXPECT_EQ(read.values[0].claim, "C10a");
        EXPECT_EQ(read.values[0].unit, "1/s");
        EXPECT_GT(read.values[0].value, 0.0);
        EXPECT_EQ(read.broke_down, &read == &all[2]);
    }
}

}  // namespace
}  // namespace readings_tests
