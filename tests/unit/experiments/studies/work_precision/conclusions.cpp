// The tables over all poses: what the kept tables do not have. Reference: rows that are made here, whose shares,
// decisions and choices are known by construction. The kept tables check the rest
// (tests/regression/experiments/kept_values.cpp).
#include "experiments/studies/work_precision/conclusions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>

namespace conclusions_tests {
namespace {

using namespace experiments;
using analysis::CsvTable;
using TableRow = CsvTable::Row;
using Decision = analysis::MethodDecision;
using enum ComparisonTable;

const std::vector<std::string> bodies = {"limb", "human", "man", "lady", "frankie"};
constexpr int movements = 40, folds = 6;  // poses
constexpr double rounding = 1e-12;        // relative, of geometric means of at most 40 numbers

// A pose by its number: eight movements of each body, then the folds.
std::string pose_name(int pose)
{
    return (pose < movements ? "movement_" : "fold_") + std::to_string(pose);
}
std::string body_of(int pose)
{
    return bodies[pose < movements ? pose / 8 : pose % 2];
}

// The error of LBS [%], different in each pose and for each member.
double error_of_lbs(int pose, std::size_t member)
{
    return (1.0 + static_cast<double>(member)) * (10.0 + 0.1 * pose);
}

// A method's error over that of LBS; nothing where the member was not reached.
using Share = std::function<std::optional<double>(int pose, std::size_t member)>;
Share everywhere(double share)
{
    return [=](int, std::size_t) { return share; };
}

// Rows of all poses, own errors of the references of 0.1 %, and settings whose names are those of their methods.
struct Rows {
    std::vector<PointRow> points = {};
    struct OwnError {
        std::string pose, body;
        Stratum stratum;
        std::string member;
        std::optional<double> own_error_pct;
    };
    std::vector<OwnError> own = {};
    std::vector<ChosenSetting> settings = {};
    std::vector<double> times_ms;

    explicit Rows(const std::vector<double>& times_of_settings_ms = {1.0}) : times_ms(times_of_settings_ms)
    {
        for (int pose = 0; pose < movements + folds; ++pose)
            for (const EnsembleMember& member : family())
                own.push_back({pose_name(pose), body_of(pose), stratum_of(pose), member.name, 0.1});
        add("lbs", 0.02, everywhere(1.0));
    }

    static Stratum stratum_of(int pose) { return pose < movements ? Stratum::movement : Stratum::fold; }

    // With one setting for these times, of which 1 ms is that of a table.
    void add(const std::string& method, double ms, const Share& share, GivenFlesh flesh = GivenFlesh::none)
    {
        add_points(method, "of_" + method, ms, share, flesh);
        for (const double budget_ms : times_ms) settings.push_back({budget_ms, method, "of_" + method, ms, 1.0});
    }

    void add_points(const std::string& method, const std::string& setting, double ms, const Share& share,
                    GivenFlesh flesh)
    {
        for (int pose = 0; pose < movements + folds; ++pose) {
            PointRow& row = points.emplace_back(
                PointRow{.pose = pose_name(pose), .body = body_of(pose), .stratum = stratum_of(pose)});
            row.method = method, row.flesh = flesh, row.setting = setting, row.outcome = "finished";
            row.ms = ms, row.times_pbs = 2.0 * ms, row.skin_mm = 3.0;
            for (std::size_t m = 0; m < members_of_family; ++m)
                if (const auto of_lbs = share(pose, m)) row.errors[m] = *of_lbs * error_of_lbs(pose, m);
        }
    }

    Comparison concluded() const
    {
        CsvTable own_errors(own_error_columns, "references.csv");
        for (const OwnError& error : own)
            own_errors.add_row({error.pose, error.body, error.stratum, error.member, "reached", error.own_error_pct});
        return experiments::concluded(table_of(point_columns, points), own_errors, settings);
    }
};

TableRow method_row(const Comparison& comparison, ComparisonTable table, double budget_ms, const std::string& method)
{
    return comparison.methods.find({{"table", table}, {"budget_ms", budget_ms}, {"method", method}}).value();
}

std::vector<std::string> ranked(const Comparison& comparison, ComparisonTable table, double budget_ms)
{
    return comparison.methods.where({{"table", table}, {"budget_ms", budget_ms}}).map([](const TableRow& row) {
        return row.text("method") + " " + row.text("letters");
    });
}

Decision decision(const Comparison& comparison, const std::string& first, const std::string& second,
                  ComparisonTable table = known, double budget_ms = 1.0)
{
    return comparison.decisions
        .find({{"table", table}, {"budget_ms", budget_ms}, {"without_body", ""}, {"first", first}, {"second", second}})
        .value()
        .value<Decision>("decision");
}

// Flesh of each reference leaves 10 to 17 % of LBS's error, flesh of the first member 10 % against it and 90 % against
// all others.
Rows four_methods(const std::vector<double>& times_ms = {1.0})
{
    Rows rows(times_ms);
    rows.add("delta_mush", 0.05, everywhere(0.6));
    rows.add("pbs", 0.3, everywhere(0.5));
    rows.add(
        "quasi_newton", 0.6, [](int, std::size_t m) { return 0.1 + 0.01 * static_cast<double>(m); }, GivenFlesh::own);
    rows.add_points(
        "quasi_newton", "of_quasi_newton", 0.6, [](int, std::size_t m) { return m == 0 ? 0.1 : 0.9; },
        GivenFlesh::standard);
    return rows;
}

const Comparison& comparison_of_four()
{
    static const Comparison comparison = four_methods(comparison_times().tables_ms).concluded();
    return comparison;
}

// Twice the time of a setting on this machine is within the budget, only its time is, or not even that.
TEST(Conclusions, StateWhetherTheTimeIsKept)
{
    const Comparison& comparison = comparison_of_four();
    const auto within = [&](double budget_ms, const char* name) {
        return method_row(comparison, known, budget_ms, name).text("within");
    };
    EXPECT_EQ(within(10.0, "quasi_newton"), "doubled");
    EXPECT_EQ(within(1.0, "quasi_newton"), "once");
    EXPECT_EQ(within(0.1, "quasi_newton"), "no");
    EXPECT_EQ(within(0.1, "delta_mush"), "doubled") << "equal";
}

// On one member PBS is farther than LBS.
TEST(Conclusions, AreNotChangedByAMemberWithoutAnOwnError)
{
    constexpr std::size_t other = 4;
    const std::string name = family()[other].name;
    Rows rows;
    rows.add("pbs", 0.3, [](int, std::size_t m) { return m == other ? 2.0 : 0.5; });
    EXPECT_EQ(decision(rows.concluded(), "lbs", "pbs"), Decision::depends);
    for (Rows::OwnError& row : rows.own)
        if (row.member == name) row.own_error_pct.reset();
    EXPECT_EQ(decision(rows.concluded(), "lbs", "pbs"), Decision::second_is_nearer);
    std::erase_if(rows.own, [&](const Rows::OwnError& row) { return row.member == name; });
    EXPECT_EQ(decision(rows.concluded(), "lbs", "pbs"), Decision::second_is_nearer) << "without rows";
}

TEST(Conclusions, CountInvertedTetsByMovementAndHaveNoShareOfFoldsWithoutFolds)
{
    Rows rows;
    rows.add("pbs", 0.3, everywhere(0.5));
    for (PointRow& row : rows.points)
        row.inverted = row.method == "pbs" && (row.pose == pose_name(1) || row.pose == pose_name(41)) ? 7 : 0;
    const TableRow pbs = method_row(rows.concluded(), known, 1.0, "pbs");
    EXPECT_EQ(pbs.integer("inverted_poses"), 1);
    EXPECT_EQ(pbs.number("times_pbs"), 0.6);
    std::erase_if(rows.points, [](const PointRow& row) { return row.stratum == Stratum::fold; });
    EXPECT_EQ(method_row(rows.concluded(), known, 1.0, "pbs").text("fold_share"), "");
}

// It has no setting, and no time before it is measured.
TEST(Conclusions, HaveAMethodOfTheUsersOwnWithinTimesThatItKeeps)
{
    Rows rows = four_methods(comparison_times().budgets_ms);
    rows.add_points("mine", "", 0.5, everywhere(0.2), GivenFlesh::none);
    const Comparison comparison = rows.concluded();
    const CsvTable mine = comparison.methods.where("method", "mine");
    for (const TableRow& row : mine) {
        EXPECT_NEAR(row.number("share"), 0.2, rounding);
        EXPECT_EQ(row.text("takes"), "");
    }
    EXPECT_EQ(mine.where("table", known).numbers("budget_ms"), (std::vector<double>{1.0, 10.0}));
    EXPECT_EQ(comparison.curves.where({{"table", known}, {"method", "mine"}}).numbers("budget_ms"),
              (std::vector<double>{0.5, 1.0, 2.0, 5.0, 10.0}));
    EXPECT_EQ(decision(comparison, "pbs", "mine"), Decision::second_is_nearer);
    EXPECT_EQ(decision(comparison, "quasi_newton", "mine"), Decision::first_is_nearer);
    EXPECT_EQ(decision(comparison, "quasi_newton", "mine", guessed), Decision::depends);
}

// 190 ms are more than each time: the table of any time has the method, beside the others with their settings of the
// longest time.
TEST(Conclusions, HaveASlowMethodOfTheUsersOwnAtAnyTime)
{
    constexpr double any_time_ms = std::numeric_limits<double>::infinity();
    Rows rows = four_methods(comparison_times().budgets_ms);
    EXPECT_TRUE(ranked(rows.concluded(), known, any_time_ms).empty()) << "without a slow method there is no such table";
    rows.add_points("mine", "", 190.0, everywhere(0.2), GivenFlesh::none);
    rows.add_points("quick", "", 0.5, everywhere(0.9), GivenFlesh::none);
    const Comparison comparison = rows.concluded();
    EXPECT_NEAR(method_row(comparison, known, any_time_ms, "mine").number("share"), 0.2, rounding);
    EXPECT_EQ(method_row(comparison, known, any_time_ms, "pbs").text("setting"), "of_pbs");
    EXPECT_EQ(ranked(comparison, known, any_time_ms).size(), ranked(comparison, known, 10.0).size() + 1);
    EXPECT_NEAR(method_row(comparison, guessed, any_time_ms, "quick").number("share"), 0.9, rounding);
    EXPECT_EQ(decision(comparison, "pbs", "mine", known, any_time_ms), Decision::second_is_nearer);
    EXPECT_EQ(comparison.curves.where({{"method", "mine"}, {"budget_ms", any_time_ms}}).rows(), 2)
        << "one point in each table";
    EXPECT_EQ(comparison.profiles.where("budget_ms", any_time_ms).rows(), 0);
}

TEST(Conclusions, HaveACurveOverAllTimes)
{
    Rows rows(comparison_times().budgets_ms);
    rows.add("pbs", 0.3, everywhere(0.5));
    rows.add_points("pbs", "in_haste", 0.04, everywhere(0.8), GivenFlesh::none);
    for (ChosenSetting& chosen : rows.settings)
        if (chosen.method == "pbs" && chosen.budget_ms < 0.5) chosen.setting = "in_haste";
    const CsvTable curve = rows.concluded().curves.where({{"table", known}, {"method", "pbs"}});
    ASSERT_EQ(curve.numbers("budget_ms"), comparison_times().budgets_ms);
    for (int i = 0; i < curve.rows(); ++i) {
        EXPECT_NEAR(curve.number(i, "share"), i < 3 ? 0.8 : 0.5, rounding);
        EXPECT_TRUE(curve[i].has({{"setting", i < 3 ? "in_haste" : "of_pbs"}, {"ms", i < 3 ? 0.04 : 0.3}})) << i;
    }
}

// Of three poses with another start. PBS leaves half of LBS's error in these and 90 % in the others.
TEST(OtherStarts, AreComparedInTheirOwnPosesAgainstTheFirstMember)
{
    Rows rows;
    rows.add("pbs", 0.3, [](int pose, std::size_t) { return pose < 3 ? 0.5 : 0.9; });
    rows.add_points(
        "pbs_from_the_initial_guess", "of_pbs", 0.3,
        [](int, std::size_t m) { return m == 0 ? std::optional(0.4) : std::nullopt; }, GivenFlesh::start);
    std::erase_if(rows.points, [](const PointRow& row) {
        return row.flesh == GivenFlesh::start && row.pose != pose_name(0) && row.pose != pose_name(1) &&
               row.pose != pose_name(2);
    });
    const Comparison comparison = rows.concluded();
    ASSERT_EQ(comparison.starts.rows(), 1);
    const TableRow row = comparison.starts[0];
    EXPECT_TRUE(row.has({{"budget_ms", 1.0}, {"method", "pbs_from_the_initial_guess"}, {"of", "pbs"}, {"poses", 3}}));
    EXPECT_NEAR(row.number("share"), 0.4, rounding);
    EXPECT_NEAR(row.number("share_of_setting"), 0.5, rounding);
    EXPECT_EQ(ranked(comparison, known, 1.0), (std::vector<std::string>{"pbs a", "lbs b"}))
        << "a start has no row of its own";
}

// By hand: geometric means sqrt(0.5 0.5) and sqrt(0.25 0.5) over the two frames.
TEST(Motion, HasTheSharesOfTheColdAndThePlayedFrames)
{
    CsvTable played(played_columns, "played.csv");
    const auto add = [&](const char* pose, const char* method, FrameGuess start, double error_pct, double skin_mm,
                         double ms) {
        played.add_row({pose, "01_01", method, std::string("of_") + method, start, "smooth", ms, error_pct, skin_mm});
    };
    for (const auto& [pose, error_pct] : {std::pair("one", 10.0), {"two", 20.0}})
        for (const FrameGuess start : {FrameGuess::cold, FrameGuess::frame_before})
            add(pose, "lbs", start, error_pct, 8.0, 0.02);
    add("one", "pbs", FrameGuess::cold, 5.0, 3.0, 0.2);
    add("two", "pbs", FrameGuess::cold, 10.0, 5.0, 0.2);
    add("one", "pbs", FrameGuess::frame_before, 2.5, 1.0, 0.3);
    add("two", "pbs", FrameGuess::frame_before, 10.0, 3.0, 0.5);
    const std::vector<ChosenSetting> settings = {
        {1.0, "lbs", "of_lbs"}, {0.5, "pbs", "of_pbs"}, {1.0, "pbs", "of_pbs"}, {10.0, "pbs", "other"}};
    const CsvTable rows = concluded_motion(played, settings);
    ASSERT_EQ(rows.rows(), 2) << "of the times of the tables, and of settings that were played";
    const TableRow pbs = rows.find({{"method", "pbs"}}).value();
    EXPECT_TRUE(
        pbs.has({{"clip", "01_01"}, {"budget_ms", 1.0}, {"setting", "of_pbs"}, {"member", "smooth"}, {"frames", 2}}));
    EXPECT_NEAR(pbs.number("cold_share"), 0.5, rounding);
    EXPECT_NEAR(pbs.number("played_share"), std::sqrt(0.125), rounding);
    EXPECT_EQ(pbs.number("cold_skin_mm"), 4.0);
    EXPECT_EQ(pbs.number("played_skin_mm"), 2.0);
    EXPECT_EQ(pbs.number("ms"), 0.4) << "the median of 0.3 and 0.5";
}

// Settings of PBS in two training poses.
std::vector<PointRow> trained(const std::string& setting, double ms,
                              const std::vector<std::optional<double>>& errors_pct)
{
    std::vector<PointRow> rows;
    for (std::size_t pose = 0; pose < errors_pct.size(); ++pose) {
        PointRow& row = rows.emplace_back(
            PointRow{.pose = "training_" + std::to_string(pose), .stratum = Stratum::training, .method = "pbs"});
        row.setting = setting;
        row.outcome = errors_pct[pose] ? "finished" : "not_finite";
        row.ms = pose == 0 ? 0.5 * ms : 1.5 * ms;  // the mean counts
        row.errors[0] = row.errors[6] = errors_pct[pose];
    }
    return rows;
}

std::map<double, ChosenSetting> chosen_from(const std::vector<std::vector<PointRow>>& tables)
{
    std::vector<PointRow> training;
    for (const auto& rows : tables) training.insert(training.end(), rows.begin(), rows.end());
    std::map<double, ChosenSetting> chosen;
    for (const ChosenSetting& one : chosen_settings(table_of(point_columns, training))) {
        EXPECT_EQ(one.method, "pbs");
        chosen[one.budget_ms] = one;
    }
    return chosen;
}

// The geometric means are 8, 6, 4 and 3; the arithmetic mean of the third, 8.5, is above that of the second.
TEST(ChosenSettings, HaveTheLeastGeometricMeanErrorWithinEachTime)
{
    const auto chosen = chosen_from({trained("quick", 0.08, {8.0, 8.0}), trained("slow", 0.5, {6.0, 6.0}),
                                     trained("uneven", 0.4, {1.0, 16.0}), trained("long", 12.0, {3.0, 3.0})});
    std::map<double, std::string> settings;
    for (const auto& [budget_ms, one] : chosen) settings[budget_ms] = one.setting;
    EXPECT_EQ(settings, (std::map<double, std::string>{{0.1, "quick"},
                                                       {0.2, "quick"},
                                                       {0.5, "uneven"},
                                                       {1.0, "uneven"},
                                                       {2.0, "uneven"},
                                                       {5.0, "uneven"},
                                                       {10.0, "uneven"}}));
    EXPECT_NEAR(chosen.at(1.0).training_error_pct, 4.0, 10.0 * rounding);
    EXPECT_NEAR(chosen.at(1.0).training_ms, 0.4, rounding);
}

TEST(ChosenSettings, AreFiniteInAllPosesOfAllBodies)
{
    const std::vector<PointRow> sound = trained("sound", 0.3, {8.0, 8.0});
    EXPECT_EQ(chosen_from({sound, trained("of_one_body", 0.3, {2.0})}).at(1.0).setting, "sound")
        << "a ladder that ended early on one body";
    EXPECT_EQ(chosen_from({sound, trained("diverging", 0.3, {2.0, std::nullopt})}).at(1.0).setting, "sound");
    EXPECT_EQ(chosen_from({sound, trained("better", 0.3, {2.0, 7.0})}).at(1.0).setting, "better");
}

}  // namespace
}  // namespace conclusions_tests
