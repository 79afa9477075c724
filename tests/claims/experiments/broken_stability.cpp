// C08 from cells of a jiggling limb with a distorted initial state, with the correct solver and with broken ones. Reference:
// - volume sign: each projection doubles the error that it should remove, so the limb diverges and the claim is not reproduced.
// - nothing projected: flesh falls freely, g t^2 / 2 = 4.9 m in a second, and diverges; without jiggle nothing moves at all.
// - one class dropped: a projection removes at most its own error, and the other classes still hold the body, so the verdict stays.
// - multipliers forgotten: XPBD is not part of the claim; each of its projections still takes a share below one, so it is as stable as with
//   them.
#include "experiments/studies/stability/cell_table.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;
using analysis::StabilityOutcome;
using analysis::VerdictKind;
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
    analysis::Records records;
    const test_support::ScratchFolder folder;
    stability_measurements(measured).write(folder / "measurements.csv");
    records.measurements = analysis::measurements(folder / "measurements.csv");
    return judge(test_support::claim("C08"), records).kind;
}

bool ran_away(const CellResult& result)
{
    return result.stability.outcome == StabilityOutcome::diverged || result.stability.outcome == StabilityOutcome::not_finite;
}

TEST(BrokenStability, TheSignTurnedRoundRunsAway)
{
    for (const Broken sound : {Broken::nothing, Broken::nothing_in_plain_order})
        EXPECT_EQ(verdict(true, sound), VerdictKind::reproduced) << name_of(sound);
    EXPECT_EQ(verdict(true, Broken::volume_sign), VerdictKind::not_reproduced);
}

TEST(BrokenStability, OneClassLessTakesNoBoundAway)
{
    for (const Broken how : {Broken::bind_dropped, Broken::stretch_dropped, Broken::volume_dropped})
        EXPECT_EQ(verdict(true, how), VerdictKind::reproduced) << name_of(how);
}

TEST(BrokenStability, WithNothingProjectedFleshFallsAndWhatHasNoWeightStays)
{
    EXPECT_EQ(verdict(true, Broken::nothing_projected), VerdictKind::not_reproduced);
    EXPECT_EQ(verdict(false, Broken::nothing_projected), VerdictKind::reproduced);
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
