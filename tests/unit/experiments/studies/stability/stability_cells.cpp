// Reference: the requirements on a sweep; a cell counts for the claim if its base and all its factors are the paper's.

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/solver/options.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace stability_cells_tests {
namespace {

using namespace experiments;

pbs::PbsOptions pbs_of(const StabilityCell& cell)
{
    return options_of<pbs::PbsOptions>(cell.spec);
}

// The cells of a list that vary this factor alone, of one model and precision.
std::vector<StabilityCell> swept(const std::string& list, const std::string& factor, const std::string& model,
                                 const std::string& precision)
{
    std::vector<StabilityCell> cells = stability_cells(list);
    std::erase_if(cells, [&](const StabilityCell& cell) {
        return cell.factor != factor || !cell.second_factor.empty() || cell.model != model ||
               precision_of(cell) != precision;
    });
    EXPECT_FALSE(cells.empty()) << factor;
    return cells;
}

// Each value reaches the setting that its factor names, and no other setting of PBS.
TEST(CellSweep, SetsWhatItsFactorNames)
{
    struct Varied {
        const char* factor;
        double (*set)(const pbs::PbsOptions& options);
        void (*reset)(pbs::PbsOptions& options);
    };
    const Varied factors[] = {
        {"k_stretch",
         [](const auto& options) { return options.k_stretch == options.jiggle->k_stretch ? options.k_stretch : -1.0; },
         [](auto& options) { options.k_stretch = options.jiggle->k_stretch = 0.2; }},
        {"k_volume", [](const auto& options) { return options.k_volume; },
         [](auto& options) { options.k_volume = 1.0; }},
        {"k_bind", [](const auto& options) { return options.k_bind; }, [](auto& options) { options.k_bind = 1.0; }},
        {"iterations", [](const auto& options) { return double(options.iterations); },
         [](auto& options) { options.iterations = 24; }},
        {"gravity", [](const auto& options) { return options.gravity_m_s2.y() / -9.81; },
         [](auto& options) { options.gravity_m_s2.y() = -9.81; }}};
    DeformerSpec base = swept("pbs_jiggle", "twist", "pbs_jiggle", "f64").front().spec;
    for (const auto& [factor, set, reset] : factors) {
        double before = -1.0;
        for (const StabilityCell& cell : swept("pbs_jiggle", factor, "pbs_jiggle", "f64")) {
            EXPECT_DOUBLE_EQ(set(pbs_of(cell)), cell.value) << factor;
            EXPECT_GT(cell.value, before) << factor;
            before = cell.value;
            DeformerSpec others = cell.spec;
            reset(options_of<pbs::PbsOptions>(others));
            EXPECT_EQ(to_json(others), to_json(base)) << factor;
        }
    }
}

// The named values, on which a cell's own factors and overrides depend, are those of the options.
TEST(CellSweep, NamesTheValuesThatAreNoNumbers)
{
    for (const StabilityCell& cell : swept("pbs", "order", "pbs", "f32"))
        EXPECT_EQ(cell.named, name_of(pbs_of(cell).order));
    for (const StabilityCell& cell : swept("pbs", "start", "pbs", "f32"))
        EXPECT_EQ(cell.named, name_of(cell.disturbance.start));
    for (const StabilityCell& cell : swept("controls", "printed_form", "pbs", "f64")) {
        EXPECT_EQ(cell.named, name_of(pbs_of(cell).volume_form));
        EXPECT_NE(cell.named, name_of(pbs::VolumeForm::derived));
    }
}

// A map has each pair of values. It is as published where its base and both of its factors are.
TEST(CellSweep, AMapHasEachPairOfValues)
{
    std::set<std::pair<double, double>> pairs;
    std::set<double> time_steps, stiffnesses;
    for (const StabilityCell& cell : stability_cells("pbs_maps")) {
        EXPECT_TRUE(cell.as_published);
        if (cell.factor != "time_step") continue;
        EXPECT_EQ(cell.second_factor, "k_stretch");
        EXPECT_EQ(cell.time_step_s, cell.value);
        EXPECT_EQ(pbs_of(cell).k_stretch, cell.second_value);
        EXPECT_TRUE(pairs.emplace(cell.value, cell.second_value).second) << "twice";
        time_steps.insert(cell.value), stiffnesses.insert(cell.second_value);
    }
    EXPECT_EQ(pairs.size(), time_steps.size() * stiffnesses.size());
    EXPECT_GE(stiffnesses.size(), 5u);
}

TEST(CellSweep, IsAsPublishedWhereItsBaseAndItsFactorAre)
{
    for (const StabilityCell& cell : stability_cells("pbs")) {
        const bool is_factor_published = cell.factor != "mass_ratio" && cell.factor != "held_end";
        EXPECT_EQ(cell.as_published, is_factor_published && cell.model == "pbs") << cell.factor;
    }
}

// --resume compares to_json; setting_of identifies shared undisturbed states.
TEST(CellSweep, ARecordTellsWhatACellStandsForAndItsSettingDoesNot)
{
    const StabilityCell cell = stability_cells("pbs_maps").front();
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
        return cell.as_published && precision_of(cell) == "f64" &&
               options_of<pbs::PbsOptions>(cell.spec).order == pbs::Order::plain;
    };
    const auto is_undisturbed = [](const StabilityCell& cell) { return cell.model == "pbs_undisturbed"; };
    std::vector<StabilityCell> limb = stability_cells("pbs_jiggle");
    append(limb, stability_cells("pbs"));
    const std::vector<StabilityCell> controls = stability_cells("controls");
    EXPECT_EQ(factors_where(controls, is_undisturbed), factors_where(limb, is_judged));
    EXPECT_GE(factors_where(controls, [](const auto& cell) { return cell.model == "pbs_printed_sign"; }).size(), 5u);
    for (const StabilityCell& cell : controls) EXPECT_FALSE(cell.as_published) << cell.model;
    const std::vector<StabilityCell> lady = stability_cells("pbs_character", "lady");
    EXPECT_EQ(factors_where(lady, is_undisturbed), factors_where(lady, is_judged));
    for (const StabilityCell& cell : lady) EXPECT_NE(cell.as_published, is_undisturbed(cell));
    EXPECT_TRUE(
        std::ranges::any_of(lady, [&](const auto& cell) { return is_judged(cell) && cell.time_step_s >= 0.05; }));
}

// The deformers that are compared with PBS in the study of stability. Reference: the list of methods and of extreme
// cases that the study must have, written down here again; and settings beyond the limit of a method, which must be
// seen to fail.

using analysis::StabilityOutcome;

const std::set<std::string> minimising_kinds = {"quasi_newton", "vbd", "warped_newton", "xpbd_neo_hookean",
                                                "projective_dynamics"};
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
    for (const StabilityCell& cell : stability_cells("other_deformers"))
        if (cell.model == model && cell.factor == factor && cell.value == value) return cell;
    ADD_FAILURE() << "no cell of " << model << " with " << factor << " = " << value;
    return {};
}

StabilityCell start_of(const std::string& model, Start start, const std::string& setting, double value)
{
    for (const StabilityCell& cell : stability_cells("broken_starts"))
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
    const std::vector<StabilityCell> cells = stability_cells("other_deformers");
    std::set<std::string> models;
    for (const StabilityCell& cell : cells) {
        models.insert(cell.model);
        EXPECT_FALSE(cell.as_published) << cell.model;
    }
    EXPECT_EQ(models, kinds);
    for (const std::string& model : kinds) {
        const std::set<std::string> factors = factors_of(cells, model);
        for (const char* factor :
             {"time_step", "twist", "bend_in_one_step", "teleport", "slivers_height_kept", "needles_edge_kept"})
            EXPECT_TRUE(factors.count(factor)) << model << ", " << factor;
        EXPECT_EQ(factors.count("poisson"), minimising_kinds.count(model)) << model;
    }
    EXPECT_TRUE(factors_of(cells, "pbs_author").count("own_time_step"));
}

// Each minimising deformer has each broken start, and each other deformer states why it has none.
TEST(OtherCells, EveryDeformerHasItsBrokenStarts)
{
    std::set<std::pair<std::string, Start>> starts, expected;
    for (const StabilityCell& cell : stability_cells("broken_starts")) {
        EXPECT_FALSE(cell.as_published) << cell.model;
        if (cell.second_factor.empty()) starts.insert({cell.model, cell.disturbance.start});
    }
    for (const std::string& model : minimising_kinds)
        for (const Start start : {Start::flattened, Start::mirrored, Start::random, Start::point})
            expected.insert({model, start});
    EXPECT_EQ(starts, expected);
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
    for (const StabilityCell& cell : stability_cells("other_deformers")) {
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

// With gravity the published code's own time step matters: a step of a second lets flesh fall by g h^2 = 9.8 m per
// frame.
TEST(OtherCells, TheOwnTimeStepOfPbsAuthorMatters)
{
    const auto reach = [](double time_step_s) {
        StabilityCell cell = cell_with("pbs_author", "own_time_step", time_step_s);
        cell.still_steps = 12;
        return run_cell(cell).steps.back().reach;
    };
    EXPECT_GT(reach(1.0), 10.0 * reach(1e-3));
}

// Negative controls: Chebyshev's weights for a spectral radius above that of the sweeps; time steps beyond 0.8 of the
// time in which the stiffness of a vertex moves its mass.
struct BeyondItsLimit {
    const char *model, *setting;
    double within, beyond;
};
const BeyondItsLimit beyond_limits[] = {{"vbd", "chebyshev_rho", 0.9, 0.9999},
                                        {"xpbd_neo_hookean", "step_of_stiffness", 0.8, 16.0}};

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
}  // namespace stability_cells_tests
