// C08 judged from records as the stability study writes them: a single cell that runs away turns the verdict.
#include "analysis/atomic_file.hpp"
#include "analysis/claims.hpp"
#include "analysis/measurement.hpp"
#include "analysis/verdict.hpp"
#include "experiments/stability/cell_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace {

using namespace experiments;
using analysis::StabilityOutcome;
using analysis::VerdictKind;

MeasuredCell cell_of(const std::string& factor, StabilityOutcome outcome, bool as_published = true)
{
    MeasuredCell measured;
    measured.cell.model = measured.cell.spec.kind = "pbs";
    measured.cell.factor = factor;
    measured.cell.as_published = as_published;
    measured.result.stability.outcome = outcome;
    measured.result.steps.resize(1);
    return measured;
}

VerdictKind verdict_on(const std::vector<MeasuredCell>& cells)
{
    const std::string file = (std::filesystem::temp_directory_path() / "pbs_stability_verdict.csv").string();
    stability_measurements(cells).write(file);
    analysis::Records records;
    records.measurements = analysis::measurements(file);
    std::filesystem::remove(file);
    for (const auto& claim : analysis::parse_claims(analysis::read_text(PBS_CLAIMS_FILE), "claims.toml"))
        if (claim.id == "C08") return analysis::judge(claim, records).kind;
    ADD_FAILURE() << "no claim C08";
    return VerdictKind::not_computable;
}

const std::vector<MeasuredCell> stable = {cell_of("time step", StabilityOutcome::converged),
                                          cell_of("time step", StabilityOutcome::inverted),
                                          cell_of("k_stretch", StabilityOutcome::bounded)};

std::vector<MeasuredCell> altered(std::size_t index, StabilityOutcome outcome)
{
    std::vector<MeasuredCell> cells = stable;
    cells[index].result.stability.outcome = outcome;
    return cells;
}

TEST(StabilityVerdict, NoCellThatRunsAwayIsReproduced)
{
    EXPECT_EQ(verdict_on(stable), VerdictKind::reproduced);
}

TEST(StabilityVerdict, OneCellThatRunsAwayLeavesTheOtherSweeps)
{
    for (const StabilityOutcome outcome : {StabilityOutcome::diverged, StabilityOutcome::not_finite})
        EXPECT_EQ(verdict_on(altered(0, outcome)), VerdictKind::reproduced_only_for);
}

TEST(StabilityVerdict, ACellInEverySweepIsNotReproduced)
{
    std::vector<MeasuredCell> cells = altered(0, StabilityOutcome::diverged);
    cells[2].result.stability.outcome = StabilityOutcome::not_finite;
    EXPECT_EQ(verdict_on(cells), VerdictKind::not_reproduced);
}

TEST(StabilityVerdict, CellsThatThePaperDoesNotClaimDoNotCount)
{
    std::vector<MeasuredCell> cells = stable;
    cells.push_back(cell_of("printed form", StabilityOutcome::not_finite, false));
    EXPECT_EQ(verdict_on(cells), VerdictKind::reproduced);
}

// A map in which the sign as printed looks stable, or that never shows an outcome, says nothing: the study fails.
TEST(StabilityVerdict, AMapThatCannotTellIsRefused)
{
    std::vector<MeasuredCell> cells;
    for (const StabilityOutcome outcome : {StabilityOutcome::converged, StabilityOutcome::bounded, StabilityOutcome::inverted,
                                           StabilityOutcome::diverged, StabilityOutcome::not_finite})
        cells.push_back(cell_of("time step", outcome));
    cells.push_back(cell_of("printed form", StabilityOutcome::diverged, false));
    cells.back().cell.named = "sign";
    EXPECT_EQ(blind_spots({cells_csv(cells)}), "");
    cells.back().result.stability.outcome = StabilityOutcome::converged;
    EXPECT_NE(blind_spots({cells_csv(cells)}), "");
    cells.back().result.stability.outcome = StabilityOutcome::not_finite;
    cells.erase(cells.begin() + 1);
    EXPECT_EQ(blind_spots({cells_csv(cells)}), "no cell is bounded\n");
}

TEST(StabilityVerdict, SharesAreOfTheCellsOfTheirSweep)
{
    const analysis::CsvTable shares = stability_measurements(altered(0, StabilityOutcome::diverged));
    ASSERT_EQ(shares.rows(), 6);
    EXPECT_EQ(shares.text_at(0, "of"), "limb, no jiggle, time step, f32, n = 2");
    EXPECT_EQ(shares.number(0, "value"), 0.5);  // one of two
    EXPECT_EQ(shares.number(1, "value"), 0.5);  // the inverted one
    EXPECT_EQ(shares.number(2, "value"), 0.0);
    EXPECT_EQ(shares.number(3, "value"), 0.0);  // of k_stretch
}

}  // namespace
