#include "experiments/studies/convergence/convergence_records.hpp"

#include "experiments/deformers/pbs/pbs_option_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

using Cells = std::vector<analysis::CsvTable::Cell>;

const std::vector<std::string> case_columns = {"body", "pose", "vertices", "tets", "own_mesh", "order", "precision", "k_stretch", "start"};

Cells case_cells(const ConvergencePaths& of, std::size_t start)
{
    return {of.body,
            of.pose,
            of.vertices,
            of.tets,
            int(of.own_mesh),
            name_of(of.setting.order),
            name_of(of.setting.precision),
            of.k_stretch,
            name_of(all_starts[start])};
}

template <typename T>
std::vector<T> joined(std::vector<T> first, const std::vector<T>& more)
{
    first.insert(first.end(), more.begin(), more.end());
    return first;
}

// Enough of a figure that is drawn; whole numbers would double the record.
double six_digits(double value)
{
    return std::stod(fmt::format("{:.6g}", value));
}

// Those that are looked at in a record: the first one past each fifth of a decade, and the last.
std::vector<Look> thinned(const IterationPath& path)
{
    std::vector<Look> kept;
    double next = 0.0;
    for (const Look& look : path.looks) {
        if (look.iteration < next && &look != &path.looks.back()) continue;
        kept.push_back(look);
        next = std::max(look.iteration + 1.0, std::floor(look.iteration * std::pow(10.0, 0.2)));
    }
    return kept;
}

template <typename Cells_of>
analysis::CsvTable table_by_look(const ConvergenceResult& result, const std::vector<std::string>& columns, Cells_of cells_of)
{
    analysis::CsvTable table(joined(case_columns, columns));
    for (const ConvergencePaths& paths : result.all) {
        if (!paths.own_mesh && !result.ladder) continue;  // other tessellations of one size are told of by their rates alone
        for (std::size_t start = 0; start < paths.paths.size(); ++start)
            for (const Look& look : thinned(paths.paths[start]))
                if (const Cells cells = cells_of(look); !cells.empty()) table.add_row(joined(case_cells(paths, start), cells));
    }
    return table;
}

Cells rate_cells(const ConvergencePaths& of, std::size_t start, double floor)
{
    const IterationPath& path = of.paths[start];
    const Reached residual = reached_residual(path, floor), volume = reached_volume(path);
    const Rate rate = rate_of(path, floor);
    const analysis::CsvTable::Cell nothing = std::nullopt;
    const Look &last = path.looks.back(), &half = look_at(path, last.iteration / 2), &paper = look_at(path, 24),
               &nearest = nearest_to_reference(path);
    return {last.iteration,
            path.finite ? "finished" : "not_finite",
            floor,
            path.looks.front().combined,
            paper.combined,
            last.combined,
            100.0 * (last.combined / half.combined - 1.0),
            rate.stalls_at ? analysis::CsvTable::Cell(*rate.stalls_at) : nothing,
            rate.rate.estimate,
            rate.rate.low,
            rate.rate.high,
            rate.log_rms_off,
            residual.iterations,
            int(residual.within),
            volume.iterations,
            int(volume.within),
            path.iteration_ms,
            residual.within ? analysis::CsvTable::Cell(residual.iterations * path.iteration_ms) : nothing,
            volume.within ? analysis::CsvTable::Cell(volume.iterations * path.iteration_ms) : nothing,
            paper.volume_change_pct,
            paper.volume_abs_change_pct,
            last.volume_change_pct,
            last.volume_abs_change_pct,
            last.inverted_tets,
            of.reference,
            path.looks.front().error_joint_pct,
            paper.error_joint_pct,
            nearest.error_joint_pct,
            nearest.iteration,
            last.error_joint_pct,
            int(of.reference_self_intersects),
            of.limit_from_lbs_pct[start]};
}

}  // namespace

analysis::CsvTable residual_table(const ConvergenceResult& result)
{
    return table_by_look(
        result,
        {"iteration", "stretch_rms", "volume_rms", "bind_rms_m", "combined", "volume_change_pct", "volume_abs_change_pct", "inverted_tets"},
        [](const Look& look) {
            return Cells{look.iteration,
                         six_digits(look.stretch_rms),
                         six_digits(look.volume_rms),
                         six_digits(look.bind_rms_m),
                         six_digits(look.combined),
                         six_digits(look.volume_change_pct),
                         six_digits(look.volume_abs_change_pct),
                         look.inverted_tets};
        });
}

analysis::CsvTable rate_table(const ConvergenceResult& result)
{
    analysis::CsvTable table(joined(case_columns, {"iterations",
                                                   "outcome",
                                                   "floor",
                                                   "start_residual",
                                                   "residual_24",
                                                   "last_residual",
                                                   "last_half_change_pct",
                                                   "stalls_at_iteration",
                                                   "rate_per_iteration",
                                                   "rate_low",
                                                   "rate_high",
                                                   "rate_log_rms_off",
                                                   "iterations_to_residual",
                                                   "residual_reached",
                                                   "iterations_to_volume",
                                                   "volume_reached",
                                                   "iteration_cpu_ms",
                                                   "cpu_ms_to_residual",
                                                   "cpu_ms_to_volume",
                                                   "volume_change_24_pct",
                                                   "volume_abs_change_24_pct",
                                                   "last_volume_change_pct",
                                                   "last_volume_abs_change_pct",
                                                   "last_inverted_tets",
                                                   "reference",
                                                   "start_error_pct",
                                                   "error_24_pct",
                                                   "least_error_pct",
                                                   "least_error_iteration",
                                                   "last_error_pct",
                                                   "reference_self_intersects",
                                                   "limit_from_lbs_pct"}));
    for (const ConvergencePaths& paths : result.all) {
        const double floor = floor_of(paths.paths);
        for (std::size_t start = 0; start < paths.paths.size(); ++start)
            table.add_row(joined(case_cells(paths, start), rate_cells(paths, start, floor)));
    }
    return table;
}

analysis::CsvTable towards_table(const ConvergenceResult& result)
{
    return table_by_look(result, {"iteration", "error_joint_pct"}, [](const Look& look) {
        return std::isnan(look.error_joint_pct) ? Cells{} : Cells{look.iteration, six_digits(look.error_joint_pct)};
    });
}

}  // namespace experiments
