#include "experiments/studies/fit/fit_records.hpp"

#include "experiments/deformers/pbs/pbs_option_names.hpp"

#include <cmath>

namespace experiments {
namespace {

using Cells = std::vector<analysis::CsvTable::Cell>;

const std::vector<std::string> setting_columns = {"vertices",    "mean_edge_m", "k_stretch",     "k_volume", "iterations",
                                                  "time_step_s", "masses",      "density_kg_m3", "poisson"};

std::vector<std::string> with_setting(const std::vector<std::string>& columns)
{
    std::vector<std::string> all = setting_columns;
    all.insert(all.end(), columns.begin(), columns.end());
    return all;
}

Cells cells_of(const FitSetting& setting)
{
    const pbs::PbsOptions& pbs = setting.pbs;
    return {setting.vertices,    setting.mean_edge_m, pbs.k_stretch,         pbs.k_volume,   pbs.iterations,
            setting.time_step_s, name_of(pbs.masses), setting.density_kg_m3, setting.poisson};
}

void add(analysis::CsvTable& table, Cells cells, const Cells& more)
{
    cells.insert(cells.end(), more.begin(), more.end());
    table.add_row(cells);
}

Cells cells_of(const analysis::Minimum& minimum)
{
    return {minimum.value, minimum.rise, analysis::name_of(minimum.outcome), minimum.identifiable() ? 1 : 0};
}

Cells cells_of(const PoissonSetting& setting)
{
    return {setting.model, setting.element_order, setting.formulation, setting.attachment,
            setting.body,  setting.k_stretch,     setting.iterations};
}

}  // namespace

analysis::CsvTable sag_table()
{
    return analysis::CsvTable(
        with_setting({"young_pa", "young_low_pa", "young_high_pa", "misfit_pct", "rise", "outcome", "identifiable",
                      "young_dt2_over_density_edge2_iterations", "tip_sag_over_g_dt2", "settled", "residual", "solver_steps"}));
}

void add_sag(analysis::CsvTable& table, const FitSetting& setting, const RestingState& state, double tip_sag_over_g_dt2,
             const YoungFit& fit)
{
    const double dt_edge = setting.time_step_s / setting.mean_edge_m;
    const double number = fit.young_pa.estimate * dt_edge * dt_edge / setting.density_kg_m3 / setting.pbs.iterations;
    Cells cells = {fit.young_pa.estimate, fit.young_pa.low, fit.young_pa.high};
    const Cells minimum = cells_of(fit.minimum);
    cells.insert(cells.end(), minimum.begin(), minimum.end());
    const Cells rest = {number, tip_sag_over_g_dt2, state.converged ? 1 : 0, state.residual, state.steps};
    cells.insert(cells.end(), rest.begin(), rest.end());
    add(table, cells_of(setting), cells);
}

analysis::CsvTable swing_table()
{
    return analysis::CsvTable(with_setting({"frequency_hz", "damping_ratio", "undamped_hz", "half_periods", "steps", "outcome", "young_pa",
                                            "young_sag_pa", "young_over_sag", "expected_over_sag"}));
}

void add_swing(analysis::CsvTable& table, const FitSetting& setting, const SwingYoung& swing)
{
    const ReleaseTest& test = swing.test;
    add(table, cells_of(setting),
        {test.frequency_hz, test.damping_ratio, test.undamped_hz, test.half_periods, test.steps, name_of(test.outcome), swing.young_pa,
         swing.young_sag_pa, swing.young_pa / swing.young_sag_pa, swing.expected_ratio});
}

// Of one mode: s of the iterations rests at x = a dt^2 s / (1 - s), so static_rad^2 = (1 - s) / s. In time z = s +- i sqrt(s (1 - s)).
double frequency_over_sag(double static_rad)
{
    const double s = 1.0 / (1.0 + static_rad * static_rad);
    const double swing_rad = std::hypot(std::acos(std::sqrt(s)), std::log(s) / 2.0);  // |log z|: undamped
    return swing_rad * swing_rad / (static_rad * static_rad);
}

analysis::CsvTable poisson_table()
{
    return analysis::CsvTable({"model", "element_order", "formulation", "attachment", "body", "k_stretch", "iterations", "converged_poses",
                               "poses", "poisson", "poisson_low", "poisson_high", "misfit_pct", "rise", "outcome", "identifiable",
                               "misfit_at_0_pct", "misfit_at_highest_pct", "highest_poisson"});
}

analysis::CsvTable poisson_poses_table()
{
    return analysis::CsvTable({"model", "element_order", "formulation", "attachment", "body", "k_stretch", "iterations", "pose", "poisson",
                               "misfit_pct", "rise", "outcome", "identifiable"});
}

analysis::CsvTable valley_table()
{
    return analysis::CsvTable(
        {"model", "element_order", "formulation", "attachment", "body", "k_stretch", "iterations", "poisson", "misfit_pct"});
}

void add_poisson(analysis::CsvTable& fits, analysis::CsvTable& poses, analysis::CsvTable& valleys, const PoissonSetting& setting,
                 const PoissonFit& fit)
{
    const analysis::FittedParameter& poisson = fit.poisson;
    Cells cells = {setting.converged_poses, static_cast<int>(fit.poses.size()), poisson.interval.estimate, poisson.interval.low,
                   poisson.interval.high};
    const Cells minimum = cells_of(poisson.all);
    cells.insert(cells.end(), minimum.begin(), minimum.end());
    cells.insert(cells.end(), {fit.valley.front().value, fit.valley.back().value, fit.highest_poisson});
    add(fits, cells_of(setting), cells);
    for (std::size_t p = 0; p < fit.poses.size(); ++p) {
        Cells of_pose = {fit.poses[p], poisson.cases[p].x};
        const Cells rest = cells_of(poisson.cases[p]);
        of_pose.insert(of_pose.end(), rest.begin(), rest.end());
        add(poses, cells_of(setting), of_pose);
    }
    for (const auto& point : fit.valley) add(valleys, cells_of(setting), {point.parameter, point.value});
}

}  // namespace experiments
