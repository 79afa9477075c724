#include "experiments/studies/work_precision/point_row.hpp"

#include "analysis/frame_metrics.hpp"
#include "experiments/deformers/delta_mush/delta_mush.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "experiments/deformers/xpbd/xpbd_options.hpp"

#include <cmath>

namespace experiments {
namespace {

using Cell = analysis::CsvTable::Cell;
using Cells = std::vector<Cell>;

Cell cell_of(const std::optional<double>& value)
{
    if (value) return *value;
    return std::nullopt;
}

Cells cells_of(const PointSetting& setting)
{
    const DeformerSpec& spec = setting.spec;
    Cells cells(6, std::nullopt);  // iterations, k_stretch, order, precision, substeps, element_order
    if (const auto* mush = options_if<DeltaMushOptions>(spec)) cells[0] = mush->iterations;
    if (const auto* xpbd = options_if<XpbdOptions>(spec)) cells[0] = xpbd->iterations, cells[4] = xpbd->substeps;
    if (const auto* fem = options_if<FemOptions>(spec)) cells[5] = fem->element_order;
    if (const auto* pbs = options_if<pbs::PbsOptions>(spec))
        cells = {pbs->iterations, pbs->k_stretch, name_of(pbs->order), name_of(pbs->precision), setting.substeps, std::nullopt};
    return cells;
}

std::string outcome_of(const ReachedPoint& point, const ReachedReference& reference)
{
    if (&point == reference.point) return "reference";
    if (point.shape.finished) return "finished";
    return point.shape.positions.allFinite() ? "not_converged" : "not_finite";
}

Cells time_cells(const FrameTime& time)
{
    if (!time.ms) return {0, time.failed_rounds, std::nullopt, std::nullopt, std::nullopt};
    Cells cells = {time.ms->rounds, time.failed_rounds, time.ms->median, std::nullopt, std::nullopt};
    if (time.ms->rounds >= fewest_for_quartiles) cells[3] = time.ms->lower, cells[4] = time.ms->upper;
    return cells;
}

Cells error_cells(const std::optional<analysis::ErrorNorms>& error)
{
    if (!error) return Cells(3, std::nullopt);
    return {error->joint_pct, error->l2_pct, error->linf_m};
}

Cells reference_cells(const ReachedReference& reference, const PointFigures& figures)
{
    if (!reference.point) return Cells(7, std::nullopt);
    Cells cells(7, std::nullopt);
    cells[0] = reference.point->setting->spec.name;
    cells[6] = int(figures.reference_self_intersects);
    if (!reference.bar) return cells;
    cells[1] = reference.bar->joint_pct;
    cells[2] = reference.bar->l2_pct;
    cells[3] = reference.beside->setting->words;
    cells[4] = cell_of(figures.beside_pct);
    if (figures.error) cells[5] = int(figures.error->joint_pct <= reference.bar->joint_pct);
    return cells;
}

Cells part_cells(const ReachedReference& reference, const std::optional<PbsParts>& parts)
{
    if (!parts) return Cells(4, std::nullopt);
    Cells cells = {parts->solver_pct, parts->model_pct, std::nullopt, parts->not_converged_pct};
    if (reference.bar) cells[2] = reference.bar->joint_pct;
    return cells;
}

}  // namespace

const std::vector<std::string>& point_columns()
{
    static const std::vector<std::string> columns = {"body",
                                                     "pose",
                                                     "deformer",
                                                     "setting",
                                                     "iterations",
                                                     "k_stretch",
                                                     "order",
                                                     "precision",
                                                     "substeps",
                                                     "element_order",
                                                     "vertices",
                                                     "tets",
                                                     "outcome",
                                                     "reach_ms",
                                                     "rounds",
                                                     "failed_rounds",
                                                     "ms_median",
                                                     "ms_q1",
                                                     "ms_q3",
                                                     "error_joint_pct",
                                                     "error_l2_pct",
                                                     "error_linf_m",
                                                     "volume_change_pct",
                                                     "volume_abs_change_pct",
                                                     "inverted",
                                                     "reference",
                                                     "reference_error_joint_pct",
                                                     "reference_error_l2_pct",
                                                     "beside",
                                                     "error_joint_beside_pct",
                                                     "below_reference_error",
                                                     "reference_self_intersects",
                                                     "solver_pct",
                                                     "model_pct",
                                                     "discretisation_pct",
                                                     "not_converged_pct"};
    return columns;
}

FrameTime frame_time(std::vector<double> samples)
{
    FrameTime time;
    time.failed_rounds = static_cast<int>(std::erase_if(samples, [](double ms) { return std::isnan(ms); }));
    if (!samples.empty()) time.ms = spread_of(samples);
    return time;
}

Cells point_row(const ReachedPoint& point, const ReachedReference& reference, const PointFigures& figures)
{
    const pbs::TetMesh& mesh = point.mesh->character().mesh;
    const analysis::FrameMetrics metrics = analysis::Ruler(mesh.rest, mesh.tets).measure(point.shape.positions);
    Cells row = {figures.body, figures.pose, point.setting->deformer, point.setting->words};
    const auto add = [&](const Cells& cells) { row.insert(row.end(), cells.begin(), cells.end()); };
    add(cells_of(*point.setting));
    add({int(mesh.rest.rows()), int(mesh.tets.rows()), outcome_of(point, reference), 1e3 * point.shape.seconds});
    add(time_cells(figures.time));
    add(error_cells(figures.error));
    add({metrics.volume_change_pct, metrics.volume_abs_change_pct, metrics.inverted_tets});
    add(reference_cells(reference, figures));
    add(part_cells(reference, figures.parts));
    return row;
}

}  // namespace experiments
