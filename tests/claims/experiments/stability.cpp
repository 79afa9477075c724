// C08 from the values that the stability study writes of its trials, with the correct solver and with broken ones.

#include "analysis/verdicts/measurement.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using analysis::StabilityOutcome;
using test_support::claim;

// A trial in the paper's order and f64, of which one step is left: at rest unless it has diverged.
MeasuredCell cell_of(const std::string& factor, StabilityOutcome outcome, const std::string& body = "limb",
                     double time_step_s = 0.1)
{
    MeasuredCell measured;
    measured.cell.body = body;
    measured.cell.model = "pbs";
    measured.cell.spec = default_spec("pbs");
    auto& options = options_of<pbs::PbsOptions>(measured.cell.spec);
    options.order = pbs::Order::plain;
    options.precision = pbs::Precision::f64;
    measured.cell.factor = factor;
    measured.cell.time_step_s = time_step_s;
    measured.cell.as_published = true;
    measured.result.stability.outcome = outcome;
    measured.result.steps.resize(1);
    return measured;
}

// A trial that is no part of the claim.
MeasuredCell other_cell(const std::string& model, StabilityOutcome outcome)
{
    MeasuredCell measured = cell_of("time_step", outcome);
    measured.cell.model = model;
    measured.cell.as_published = false;
    return measured;
}

std::vector<analysis::Measurement> values_from(const std::vector<MeasuredCell>& cells)
{
    const test_support::ScratchFolder folder;
    const std::string file = folder / "measurements.csv";
    stability_measurements(cells).write(file);
    return analysis::measurements(file);
}

const StabilityOutcome ran_away_outcomes[] = {StabilityOutcome::diverged, StabilityOutcome::not_finite};

TEST(StabilityVerdict, ATrialIsCountedByTheSizeOfItsTimeStep)
{
    const auto written = [](double time_step_s, const std::string& quantity) {
        const auto values = values_from({cell_of("time_step", StabilityOutcome::converged, "limb", time_step_s)});
        return !test_support::values_of(values, "share_of_cells_at_rest_in_" + quantity).empty();
    };
    for (const double time_step_s : {0.01, 0.05, 0.1, 0.3}) {
        EXPECT_EQ(written(time_step_s, "small_steps"), time_step_s <= 0.1) << time_step_s;
        EXPECT_EQ(written(time_step_s, "large_steps"), time_step_s >= 0.05) << time_step_s;
    }
}

// Of two trials, the first at rest. A bounded one is at rest if it no longer moves by 1e-5 diagonals per step.
TEST(StabilityVerdict, ATrialThatMovesOrIsUnsolvedOrRunsAwayIsNotAtRest)
{
    const auto share_with = [](const MeasuredCell& second) {
        const auto values = values_from({cell_of("twist", StabilityOutcome::converged), second});
        return test_support::values_of(values, "share_of_cells_at_rest_in_small_steps", {.factor = "twist"})
            .at(0)
            .value;
    };
    const MeasuredCell still = cell_of("twist", StabilityOutcome::bounded);
    MeasuredCell moving = still, unsolved = still;
    moving.result.steps.back().motion = 1e-4;
    unsolved.result.steps.back().solved = false;
    EXPECT_EQ(share_with(still), 1.0);
    EXPECT_EQ(share_with(moving), 0.5);
    EXPECT_EQ(share_with(unsolved), 0.5);
    for (const StabilityOutcome outcome : ran_away_outcomes) EXPECT_EQ(share_with(cell_of("twist", outcome)), 0.5);
}

std::string blind_spots_of(const std::vector<MeasuredCell>& cells)
{
    std::vector<CellRow> rows;
    for (const MeasuredCell& cell : cells) rows.push_back(cell_row(cell));
    return blind_spots(rows);
}

// A map in which the printed sign looks stable, or in which an outcome never occurs, is meaningless: the study fails.
TEST(StabilityVerdict, AMapThatCannotTellIsRefused)
{
    std::vector<MeasuredCell> cells;
    for (const StabilityOutcome outcome :
         {StabilityOutcome::converged, StabilityOutcome::bounded, StabilityOutcome::inverted,
          StabilityOutcome::diverged, StabilityOutcome::not_finite})
        cells.push_back(cell_of("time_step", outcome));
    cells.push_back(other_cell("pbs", StabilityOutcome::diverged));
    cells.back().cell.named = "sign";
    EXPECT_EQ(blind_spots_of(cells), "");
    cells.back().result.stability.outcome = StabilityOutcome::converged;
    EXPECT_NE(blind_spots_of(cells), "");
    cells.back().result.stability.outcome = StabilityOutcome::not_finite;
    cells.erase(cells.begin() + 1);
    EXPECT_EQ(blind_spots_of(cells), "no cell is bounded\n");
}

analysis::Measurement value_of(const std::vector<MeasuredCell>& cells, const std::string& quantity,
                               const std::string& factor = "time_step")
{
    const auto values = test_support::values_of(values_from(cells), "share_of_cells_" + quantity, {.factor = factor});
    EXPECT_EQ(values.size(), 1u) << quantity;
    return values.at(0);
}

// One of two cells diverges and the other one is inverted.
TEST(StabilityVerdict, SharesAreOfTheCellsOfTheirSweep)
{
    const std::vector<MeasuredCell> cells = {cell_of("time_step", StabilityOutcome::diverged),
                                             cell_of("time_step", StabilityOutcome::inverted),
                                             cell_of("k_stretch", StabilityOutcome::bounded)};
    EXPECT_EQ(analysis::text_of(value_of(cells, "diverged").of), "limb, pbs, plain, f64, factor time_step");
    EXPECT_EQ(value_of(cells, "diverged").n, 2);
    for (const auto& [quantity, value] : {std::pair("diverged", 0.5),
                                          {"inverted", 0.5},
                                          {"in_motion", 0.0},
                                          {"at_rest", 0.0},
                                          {"at_rest_in_small_steps", 0.5},
                                          {"at_rest_in_large_steps", 0.5}})
        EXPECT_EQ(value_of(cells, quantity).value, value) << quantity;
    EXPECT_EQ(value_of(cells, "diverged", "k_stretch").value, 0.0);
}

// Theory: none of n is at most 1 - 0.025^(1 / n), all of n at least that. The probability 1 - p = 0.025 comes from
// logarithms of magnitude 9 at most, of ten roundings (tests/unit/analysis/statistics/statistics.cpp).
TEST(StabilityVerdict, ReportedSharesHaveAnIntervalAndTheJudgedOnesHaveNone)
{
    const std::vector<MeasuredCell> cells = {cell_of("time_step", StabilityOutcome::converged)};
    for (const char* judged : {"diverged", "at_rest_in_small_steps", "at_rest_in_large_steps"})
        EXPECT_EQ(value_of(cells, judged).low, value_of(cells, judged).high) << judged;
    EXPECT_NEAR(value_of(cells, "inverted").high, 0.975, test_support::rounding_error(10, 9.0 / 0.025));
    EXPECT_EQ(value_of(cells, "inverted").low, 0.0);
}

// A motion of 1e-4 diagonals per step exceeds the 1e-5 that count as rest, whether or not tets are inverted.
TEST(StabilityVerdict, WhatMovesToTheEndIsNotAtRest)
{
    const auto share = [](StabilityOutcome outcome, const std::vector<double>& motions) {
        MeasuredCell cell = cell_of("time_step", outcome);
        cell.result.steps.resize(motions.size());
        for (std::size_t i = 0; i < motions.size(); ++i) cell.result.steps[i].motion = motions[i];
        return value_of({cell}, "in_motion").value;
    };
    const std::vector<double> still(12, 0.0), to_the_end(12, 1e-4);
    std::vector<double> long_ago = still;
    long_ago[0] = 1e-4;
    for (const StabilityOutcome outcome : {StabilityOutcome::bounded, StabilityOutcome::inverted}) {
        EXPECT_EQ(share(outcome, to_the_end), 1.0);
        EXPECT_EQ(share(outcome, still), 0.0);
        EXPECT_EQ(share(outcome, long_ago), 0.0);
    }
    EXPECT_EQ(share(StabilityOutcome::diverged, to_the_end), 0.0);  // counted as diverged
}

// Without jiggle the time step has no effect, so that sweep holds for any method and is not a value of the claim.
TEST(StabilityVerdict, TimeStepsThatDoNotEnterAreNotCounted)
{
    int controls = 0;
    for (const StabilityCell& cell : stability_cells("pbs")) {
        EXPECT_FALSE(cell.factor == "time_step" && cell.as_published);
        controls += cell.model == "pbs_no_memory";
    }
    EXPECT_GT(controls, 0);
    for (const StabilityCell& cell : stability_cells("pbs_jiggle"))
        EXPECT_TRUE(cell.factor != "time_step" || cell.as_published);
}

// C08 from cells of a jiggling limb with a distorted initial state, with the correct solver and with broken ones.
// Reference:
// - volume sign: each projection doubles the error that it should remove, so the limb diverges and is not at rest.
// - nothing projected: flesh falls freely, g t^2 / 2 = 4.9 m in a second, and diverges; without jiggle nothing moves at
// all.
// - one class dropped: a projection removes at most its own error, and the other classes still hold the body, so it
// stays bounded.
// - multipliers forgotten: XPBD is not part of the claim; each of its projections still takes a share below one, so it
//   is as stable as with them.

using test_support::broken;
using test_support::Broken;

constexpr int still_steps = 100;  // one second

std::vector<StabilityCell> chosen(const std::vector<StabilityCell>& cells, const std::string& factor)
{
    std::vector<StabilityCell> found;
    for (const StabilityCell& cell : cells)
        if (cell.factor == factor && cell.second_factor.empty() &&
            (!options_if<pbs::PbsOptions>(cell.spec) || precision_of(cell) == "f32")) {
            found.push_back(cell);
            found.back().still_steps = still_steps;
        }
    EXPECT_FALSE(found.empty()) << factor;
    return found;
}

// Whether the case of the broken starts holds: for the claim's own values in f32, which is quicker, and for the
// comparison `bounded`.
struct Held {
    bool at_rest, bounded;
};

Held held(bool jiggle, Broken how)
{
    std::vector<MeasuredCell> measured;
    for (StabilityCell cell : chosen(stability_cells(jiggle ? "pbs_jiggle" : "pbs"), "start")) {
        options_of<pbs::PbsOptions>(cell.spec) = broken(options_of<pbs::PbsOptions>(cell.spec), how);
        measured.push_back({cell, run_cell(cell)});
    }
    const analysis::Claim c08a = claim("C08a");
    analysis::Selection own = c08a.own;
    own.of = {.deformer = "pbs"};
    analysis::Selection bounded = *std::ranges::find(c08a.others, "bounded", &analysis::Selection::name);
    bounded.of = own.of;
    const auto holds = [&, values = values_from(measured)](const analysis::Selection& selection) {
        const analysis::Judged one = judged(c08a, selection, values);
        EXPECT_EQ(one.n, 1) << name_of(how);
        return one.held == 1;
    };
    return {holds(own), holds(bounded)};
}

TEST(BrokenStability, TheSignTurnedRoundAndNothingProjectedRunAwayAndOneClassLessTakesNoBoundAway)
{
    for (const Broken how : {Broken::nothing, Broken::nothing_in_plain_order, Broken::bind_dropped,
                             Broken::stretch_dropped, Broken::volume_dropped})
        EXPECT_TRUE(held(true, how).bounded) << name_of(how);
    for (const Broken how : {Broken::volume_sign, Broken::nothing_projected}) {
        const Held jiggling = held(true, how);
        EXPECT_FALSE(jiggling.bounded) << name_of(how);
        EXPECT_FALSE(jiggling.at_rest) << name_of(how);
    }
    EXPECT_TRUE(held(false, Broken::nothing).at_rest);
    EXPECT_FALSE(held(false, Broken::volume_sign).at_rest);
    EXPECT_TRUE(held(false, Broken::nothing_projected).at_rest) << "what has no weight stays";
}

TEST(BrokenStability, ForgottenMultipliersRunAwayNowhereAndAreNoPartOfTheClaim)
{
    std::vector<MeasuredCell> measured;
    for (StabilityCell cell : chosen(stability_cells("xpbd"), "start"))
        for (const bool keep : {true, false}) {
            options_of<pbs::XpbdOptions>(cell.spec).keep_multipliers = keep;
            measured.push_back({cell, run_cell(cell)});
            EXPECT_EQ(std::ranges::count(ran_away_outcomes, measured.back().result.stability.outcome), 0)
                << cell.named << (keep ? "" : ", multipliers forgotten");
        }
    EXPECT_EQ(stability_measurements(measured).rows(), 0);
}

}  // namespace
