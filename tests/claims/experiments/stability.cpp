// C08 judged from records like those of the stability study: a single cell that diverges changes the verdict.

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
using analysis::VerdictKind;

MeasuredCell cell_of(const std::string& factor, StabilityOutcome outcome, bool as_published = true)
{
    MeasuredCell measured;
    measured.cell.model = "pbs";
    measured.cell.spec = default_spec("pbs");
    measured.cell.factor = factor;
    measured.cell.as_published = as_published;
    measured.result.stability.outcome = outcome;
    measured.result.steps.resize(1);
    return measured;
}

VerdictKind verdict_on_cells(const std::vector<MeasuredCell>& cells)
{
    const test_support::ScratchFolder folder;
    const std::string file = folder / "measurements.csv";
    stability_measurements(cells).write(file);
    return test_support::verdict_on("C08", analysis::measurements(file));
}

const std::vector<MeasuredCell> stable = {cell_of("time_step", StabilityOutcome::converged),
                                          cell_of("time_step", StabilityOutcome::inverted),
                                          cell_of("k_stretch", StabilityOutcome::bounded)};

std::vector<MeasuredCell> altered(std::size_t index, StabilityOutcome outcome, std::vector<MeasuredCell> cells = stable)
{
    cells[index].result.stability.outcome = outcome;
    return cells;
}

TEST(StabilityVerdict, TurnsWithTheCellsThatRunAway)
{
    using enum StabilityOutcome;
    EXPECT_EQ(verdict_on_cells(stable), VerdictKind::reproduced);
    for (const StabilityOutcome outcome : {diverged, not_finite})  // the other sweeps are left
        EXPECT_EQ(verdict_on_cells(altered(0, outcome)), VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict_on_cells(altered(0, diverged, altered(2, not_finite))), VerdictKind::not_reproduced) << "a cell in every sweep";
    std::vector<MeasuredCell> not_claimed = stable;
    not_claimed.push_back(cell_of("printed_form", not_finite, false));
    EXPECT_EQ(verdict_on_cells(not_claimed), VerdictKind::reproduced) << "the paper does not claim it";
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
    for (const StabilityOutcome outcome : {StabilityOutcome::converged, StabilityOutcome::bounded, StabilityOutcome::inverted,
                                           StabilityOutcome::diverged, StabilityOutcome::not_finite})
        cells.push_back(cell_of("time_step", outcome));
    cells.push_back(cell_of("printed_form", StabilityOutcome::diverged, false));
    cells.back().cell.named = "sign";
    EXPECT_EQ(blind_spots_of(cells), "");
    cells.back().result.stability.outcome = StabilityOutcome::converged;
    EXPECT_NE(blind_spots_of(cells), "");
    cells.back().result.stability.outcome = StabilityOutcome::not_finite;
    cells.erase(cells.begin() + 1);
    EXPECT_EQ(blind_spots_of(cells), "no cell is bounded\n");
}

// The quantities of a sweep have the order of claims.toml.
TEST(StabilityVerdict, SharesAreOfTheCellsOfTheirSweep)
{
    const analysis::CsvTable shares = stability_measurements(altered(0, StabilityOutcome::diverged));
    ASSERT_EQ(shares.rows(), 8);
    EXPECT_EQ(analysis::text_of(rows_of(analysis::case_key_columns(), shares).front()), "limb, pbs, f32, factor time_step");
    EXPECT_EQ(shares.integer(0, "n"), 2);
    // One of two cells diverges and the other one is inverted; the fifth row is the first one for k_stretch.
    const double values[] = {0.5, 0.5, 0.0, 0.0, 0.0};
    for (int row = 0; row < 5; ++row) EXPECT_EQ(shares.number(row, "value"), values[row]) << row;
}

// Theory: none of n is at most 1 - 0.025^(1 / n), all of n at least that.
TEST(StabilityVerdict, ReportedSharesHaveAnIntervalAndTheJudgedOneHasNone)
{
    const analysis::CsvTable shares = stability_measurements(stable);
    for (int row = 0; row < shares.rows(); row += 4) EXPECT_EQ(shares.number(row, "high"), shares.number(row, "value"));
    EXPECT_EQ(shares.text_at(5, "quantity"), "share_of_cells_inverted");  // none of one
    // The probability 1 - p = 0.025 comes from logarithms of magnitude 9 at most, of ten roundings
    // (tests/unit/analysis/statistics/statistics.cpp).
    EXPECT_NEAR(shares.number(5, "high"), 0.975, test_support::rounding_error(10, 9.0 / 0.025));
    EXPECT_EQ(shares.number(5, "low"), 0.0);
}

// A motion of 1e-4 diagonals per step exceeds the 1e-5 that count as rest, whether or not tets are inverted.
TEST(StabilityVerdict, WhatMovesToTheEndIsNotAtRest)
{
    const auto moving = [](StabilityOutcome outcome, std::vector<double> motions) {
        MeasuredCell cell = cell_of("time_step", outcome);
        cell.result.steps.resize(motions.size());
        for (std::size_t i = 0; i < motions.size(); ++i) cell.result.steps[i].motion = motions[i];
        return cell;
    };
    const auto share = [](const MeasuredCell& cell) {
        const analysis::CsvTable shares = stability_measurements({cell});
        EXPECT_EQ(shares.text_at(2, "quantity"), "share_of_cells_in_motion");
        return shares.number(2, "value");
    };
    const std::vector<double> still(12, 0.0), to_the_end(12, 1e-4);
    std::vector<double> long_ago = still;
    long_ago[0] = 1e-4;
    for (const StabilityOutcome outcome : {StabilityOutcome::bounded, StabilityOutcome::inverted}) {
        EXPECT_EQ(share(moving(outcome, to_the_end)), 1.0);
        EXPECT_EQ(share(moving(outcome, still)), 0.0);
        EXPECT_EQ(share(moving(outcome, long_ago)), 0.0);
    }
    EXPECT_EQ(share(moving(StabilityOutcome::diverged, to_the_end)), 0.0);  // counted as diverged
}

// Without jiggle the time step has no effect, so that sweep holds for any method and is not a value of the claim.
TEST(StabilityVerdict, TimeStepsThatDoNotEnterAreNoFigure)
{
    for (const bool full : {false, true}) {
        int controls = 0;
        for (const StabilityCell& cell : pbs_cells(false, full)) {
            EXPECT_FALSE(cell.factor == "time_step" && cell.as_published);
            controls += cell.model == "pbs_no_memory";
        }
        EXPECT_GT(controls, 0);
    }
    for (const StabilityCell& cell : pbs_cells(true, false)) EXPECT_TRUE(cell.factor != "time_step" || cell.as_published);
}

// C08 from cells of a jiggling limb with a distorted initial state, with the correct solver and with broken ones. Reference:
// - volume sign: each projection doubles the error that it should remove, so the limb diverges and the claim is not reproduced.
// - nothing projected: flesh falls freely, g t^2 / 2 = 4.9 m in a second, and diverges; without jiggle nothing moves at all.
// - one class dropped: a projection removes at most its own error, and the other classes still hold the body, so the verdict stays.
// - multipliers forgotten: XPBD is not part of the claim; each of its projections still takes a share below one, so it is as stable as with
//   them.

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

VerdictKind verdict(bool jiggle, Broken how)
{
    std::vector<MeasuredCell> measured;
    for (StabilityCell cell : chosen(pbs_cells(jiggle, false), "start")) {
        options_of<pbs::PbsOptions>(cell.spec) = broken(options_of<pbs::PbsOptions>(cell.spec), how);
        measured.push_back({cell, run_cell(cell)});
    }
    return verdict_on_cells(measured);
}

bool ran_away(const CellResult& result)
{
    return result.stability.outcome == StabilityOutcome::diverged || result.stability.outcome == StabilityOutcome::not_finite;
}

TEST(BrokenStability, TheSignTurnedRoundAndNothingProjectedRunAwayAndOneClassLessTakesNoBoundAway)
{
    for (const Broken how :
         {Broken::nothing, Broken::nothing_in_plain_order, Broken::bind_dropped, Broken::stretch_dropped, Broken::volume_dropped})
        EXPECT_EQ(verdict(true, how), VerdictKind::reproduced) << name_of(how);
    for (const Broken how : {Broken::volume_sign, Broken::nothing_projected})
        EXPECT_EQ(verdict(true, how), VerdictKind::not_reproduced) << name_of(how);
    EXPECT_EQ(verdict(false, Broken::nothing_projected), VerdictKind::reproduced) << "what has no weight stays";
}

TEST(BrokenStability, ForgottenMultipliersRunAwayNowhereAndAreNoPartOfTheClaim)
{
    std::vector<MeasuredCell> measured;
    for (StabilityCell cell : chosen(xpbd_cells(false), "start"))
        for (const bool keep : {true, false}) {
            options_of<pbs::XpbdOptions>(cell.spec).keep_multipliers = keep;
            measured.push_back({cell, run_cell(cell)});
            EXPECT_FALSE(ran_away(measured.back().result)) << cell.named << (keep ? "" : ", multipliers forgotten");
        }
    EXPECT_EQ(stability_measurements(measured).rows(), 0);
}

}  // namespace
