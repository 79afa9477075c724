// Reference: the requirements on a sweep; a cell counts for the claim if its base and all its factors are the paper's.

#include "experiments/deformers/registry.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/solver/options.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace {

using namespace experiments;

StabilityCell pbs_cell()
{
    StabilityCell cell;
    cell.spec = default_spec("pbs");
    return cell;
}

Sweep iterations(bool as_published)
{
    return {"iterations",
            "1",
            {24.0, 1.0},
            {4.0},
            [](StabilityCell& cell, double n) { options_of<pbs::PbsOptions>(cell.spec).iterations = int(n); },
            as_published};
}

Sweep mass_ratio(bool as_published)
{
    return {"mass_ratio", "1", {10.0, 100.0}, {}, [](StabilityCell& cell, double ratio) { cell.mass_ratio = ratio; }, as_published};
}

TEST(CellSweep, HasItsValuesInOrderAndAMapIsAsPublishedWhereAllOfItIs)
{
    const auto quick = cells_of(iterations(true), pbs_cell(), false), full = cells_of(iterations(true), pbs_cell(), true);
    ASSERT_EQ(quick.size(), 2u);
    ASSERT_EQ(full.size(), 3u);
    EXPECT_EQ(options_of<pbs::PbsOptions>(full[1].spec).iterations, 4);
    EXPECT_EQ(full[1].value, 4.0);
    for (const bool base : {false, true})
        for (const bool rows : {false, true})
            for (const bool columns : {false, true}) {
                StabilityCell from = pbs_cell();
                from.as_published = base;
                const auto cells = cells_of_map(iterations(rows), mass_ratio(columns), from, false);
                ASSERT_EQ(cells.size(), 4u);
                for (const StabilityCell& cell : cells) EXPECT_EQ(cell.as_published, base && rows && columns);
                EXPECT_EQ(options_of<pbs::PbsOptions>(cells[1].spec).iterations, 1);
                EXPECT_EQ(cells[1].mass_ratio, 100.0);
            }
}

// --resume compares to_json; setting_of identifies shared undisturbed states.
TEST(CellSweep, ARecordTellsWhatACellStandsForAndItsSettingDoesNot)
{
    StabilityCell cell = cells_of_map(iterations(true), mass_ratio(true), pbs_cell(), false).front();
    StabilityCell judged = cell;
    judged.as_published = !cell.as_published;
    std::vector<StabilityCell> on_record_alone = {judged};
    for (const auto member : {&StabilityCell::unit, &StabilityCell::second_factor, &StabilityCell::second_unit})
        on_record_alone.emplace_back(cell).*member = "another";
    for (const StabilityCell& changed : on_record_alone) {
        EXPECT_NE(to_json(changed), to_json(cell));
        EXPECT_EQ(setting_of(changed), setting_of(cell));
    }
    StabilityCell elsewhere = cell;
    elsewhere.disturbance.angle_deg += 1.0;
    EXPECT_NE(setting_of(elsewhere), setting_of(cell));
}

// The factors of the cells that `counts` selects.
template <typename Counts>
std::set<std::string> factors_where(const std::vector<StabilityCell>& cells, Counts counts)
{
    std::set<std::string> factors;
    for (const StabilityCell& cell : cells)
        if (counts(cell)) factors.insert(cell.factor);
    return factors;
}

TEST(PbsCells, AreJudgedInThePapersOrderAndHaveTheirControls)
{
    const auto is_judged = [](const StabilityCell& cell) {
        return cell.as_published && precision_of(cell) == "f64" && options_of<pbs::PbsOptions>(cell.spec).order == pbs::Order::plain;
    };
    const auto is_undisturbed = [](const StabilityCell& cell) { return cell.model == "pbs_undisturbed"; };
    for (const bool full : {false, true}) {
        std::vector<StabilityCell> limb = stability_cells("pbs_jiggle", full);
        append(limb, stability_cells("pbs", full));
        EXPECT_EQ(factors_where(stability_cells("controls", full), is_undisturbed), factors_where(limb, is_judged));
        EXPECT_GE(
            factors_where(stability_cells("controls", full), [](const auto& cell) { return cell.model == "pbs_printed_sign"; }).size(), 5u);
        for (const StabilityCell& cell : stability_cells("controls", full)) EXPECT_FALSE(cell.as_published) << cell.model;
        const std::vector<StabilityCell> lady = stability_cells("pbs_character", full, "lady");
        EXPECT_EQ(factors_where(lady, is_undisturbed), factors_where(lady, is_judged));
        for (const StabilityCell& cell : lady) EXPECT_NE(cell.as_published, is_undisturbed(cell));
        EXPECT_TRUE(std::ranges::any_of(lady, [&](const auto& cell) { return is_judged(cell) && cell.time_step_s >= 0.05; }));
    }
}

// The deformers that are compared with PBS in the study of stability. Reference: the list of methods and of extreme cases that the study
// must have, written down here again; and settings beyond the limit of a method, which must be seen to fail.

using analysis::StabilityOutcome;

const std::set<std::string> minimising_kinds = {"quasi_newton", "vbd", "xpbd_neo_hookean", "projective_dynamics"};
const std::set<std::string> other_kinds = {"delta_mush", "direct_delta_mush", "pbs_author"};

std::set<std::string> factors_of(const std::vector<StabilityCell>& cells, const std::string& model)
{
    std::set<std::string> factors;
    for (const StabilityCell& cell : cells)
        if (cell.model == model) factors.insert(cell.factor);
    return factors;
}

StabilityCell cell_with(const std::string& model, const std::string& factor, double value)
{
    for (const StabilityCell& cell : stability_cells("other_deformers", true))
        if (cell.model == model && cell.factor == factor && cell.value == value) return cell;
    ADD_FAILURE() << "no cell of " << model << " with " << factor << " = " << value;
    return {};
}

StabilityCell start_of(const std::string& model, Start start, const std::string& setting, double value)
{
    for (const StabilityCell& cell : stability_cells("broken_starts", true))
        if (cell.model == model && cell.disturbance.start == start && cell.second_factor == setting &&
            (setting.empty() ? cell.disturbance.axis == pbs::Vec3::UnitX() : cell.second_value == value))
            return cell;
    ADD_FAILURE() << "no broken start of " << model << " with " << setting << " = " << value;
    return {};
}

// None of them is judged.
TEST(OtherCells, EveryDeformerHasEveryExtremeCase)
{
    std::set<std::string> kinds = minimising_kinds;
    kinds.insert(other_kinds.begin(), other_kinds.end());
    for (const bool full : {false, true}) {
        const std::vector<StabilityCell> cells = stability_cells("other_deformers", full);
        std::set<std::string> models;
        for (const StabilityCell& cell : cells) {
            models.insert(cell.model);
            EXPECT_FALSE(cell.as_published) << cell.model;
        }
        EXPECT_EQ(models, kinds);
        for (const std::string& model : kinds) {
            const std::set<std::string> factors = factors_of(cells, model);
            for (const char* factor : {"time_step", "twist", "bend_in_one_step", "teleport", "slivers_height_kept", "needles_edge_kept"})
                EXPECT_TRUE(factors.count(factor)) << model << ", " << factor;
            EXPECT_EQ(factors.count("poisson"), minimising_kinds.count(model)) << model;
        }
        EXPECT_TRUE(factors_of(cells, "pbs_author").count("own_time_step"));
    }
}

// Each minimising deformer has each broken start, and each other deformer states why it has none.
TEST(OtherCells, EveryDeformerHasItsBrokenStarts)
{
    for (const bool full : {false, true}) {
        std::set<std::pair<std::string, Start>> found, expected;
        for (const StabilityCell& cell : stability_cells("broken_starts", full)) {
            EXPECT_FALSE(cell.as_published) << cell.model;
            if (cell.second_factor.empty()) found.insert({cell.model, cell.disturbance.start});
        }
        for (const std::string& model : minimising_kinds)
            for (const Start start : {Start::flattened, Start::mirrored, Start::random, Start::point}) expected.insert({model, start});
        EXPECT_EQ(found, expected);
    }
    std::set<std::string> without;
    for (const StartRow& row : starts_not_applicable()) {
        EXPECT_EQ(row.outcome, StartOutcome::not_applicable);
        EXPECT_FALSE(row.reason.empty()) << row.model;
        without.insert(row.model);
    }
    EXPECT_EQ(without, other_kinds);
}

// One cell stands for all time steps of a method, which is right only if no time step changes a bit.
TEST(OtherCells, AMethodWithOneTimeStepCellUsesNone)
{
    for (const StabilityCell& cell : stability_cells("other_deformers", false)) {
        if (cell.factor != "time_step") continue;
        EXPECT_EQ(cell.named, "not_used") << cell.model;
        const auto after_a_step = [&](double time_step_s) {
            StabilityBody body(cell);
            const auto driven = make_driven_body(cell, body.character());
            driven->advance(body.drive(0), time_step_s);
            driven->advance(body.drive(1), time_step_s);
            return driven->positions();
        };
        EXPECT_EQ((after_a_step(1e-4) - after_a_step(1.0)).cwiseAbs().maxCoeff(), 0.0) << cell.model;
    }
}

// The method does not step a pose that equals the last one, so that its flesh would be at rest by definition.
TEST(OtherCells, PbsAuthorIsSteppedWhileItsPoseIsStill)
{
    StabilityCell cell = cell_with("pbs_author", "teleport", 10.0);
    cell.still_steps = 12;
    const auto moves_in_the_third_step = [&] { return run_cell(cell).steps.at(2).motion > 1e-6; };
    EXPECT_TRUE(moves_in_the_third_step());
    cell.nudge_m = 0.0;
    EXPECT_FALSE(moves_in_the_third_step());
}

// With gravity the published code's own time step matters: a step of a second lets flesh fall by g h^2 = 9.8 m per frame.
TEST(OtherCells, TheOwnTimeStepOfPbsAuthorMatters)
{
    const auto reach = [](double time_step_s) {
        StabilityCell cell = cell_with("pbs_author", "own_time_step", time_step_s);
        cell.still_steps = 12;
        return run_cell(cell).steps.back().reach;
    };
    EXPECT_GT(reach(1.0), 10.0 * reach(1e-3));
}

// Negative controls: Chebyshev's weights for a spectral radius above that of the sweeps; time steps beyond 0.8 of the time in which the
// stiffness of a vertex moves its mass.
struct BeyondItsLimit {
    const char *model, *setting;
    double within, beyond;
};
const BeyondItsLimit beyond_limits[] = {{"vbd", "chebyshev_rho", 0.9, 0.9999}, {"xpbd_neo_hookean", "step_of_stiffness", 0.8, 16.0}};

TEST(OtherCells, SettingsBeyondTheLimitOfAMethodAreSeenToFail)
{
    for (const auto& [model, setting, within, beyond] : beyond_limits) {
        EXPECT_EQ(run_cell(cell_with(model, setting, within)).stability.outcome, StabilityOutcome::converged) << model;
        const StabilityOutcome failed = run_cell(cell_with(model, setting, beyond)).stability.outcome;
        EXPECT_TRUE(failed == StabilityOutcome::diverged || failed == StabilityOutcome::not_finite) << model;
    }
}

TEST(BrokenStart, IsReachedBySoundSettings)
{
    for (const std::string& model : minimising_kinds) {
        const StartRow row = run_broken_start(start_of(model, Start::flattened, "", 0.0), 512);
        EXPECT_EQ(row.outcome, StartOutcome::reached) << model;
        ASSERT_TRUE(row.iterations_until_reached) << model;
        EXPECT_GT(*row.iterations_until_reached, 1) << model;
        EXPECT_LE(*row.from_own_result_pct, reached_within_pct) << model;
    }
}

// One iteration leaves a body where it began. Settings beyond the limit of a method diverge.
TEST(BrokenStart, IsNotReachedByTooFewIterationsOrBeyondTheLimitOfTheMethod)
{
    const StartRow hurried = run_broken_start(start_of("vbd", Start::mirrored, "", 0.0), 2);
    EXPECT_EQ(hurried.outcome, StartOutcome::not_reached);
    EXPECT_FALSE(hurried.iterations_until_reached);
    EXPECT_GT(*hurried.from_own_result_pct, reached_within_pct);
    for (const auto& [model, setting, within, beyond] : beyond_limits) {
        const StartRow row = run_broken_start(start_of(model, Start::flattened, setting, beyond), 512);
        EXPECT_TRUE(row.outcome == StartOutcome::diverged || row.outcome == StartOutcome::not_finite) << model;
    }
}

}  // namespace
