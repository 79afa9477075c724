#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/command_line/measure/file_reference.hpp"
#include "experiments/command_line/measure/frame_points.hpp"
#include "experiments/command_line/measure/measured_frames.hpp"
#include "experiments/command_line/measure/rest_mesh.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/broken_frames.hpp"
#include "experiments/run/metrics_table.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

namespace experiments {
namespace {

// The worst tet of a frame with inverted tets. The reader refuses frames that are not finite.
std::string worst_of(const analysis::MeshMetrics& mesh_metrics, const pbs::Positions& positions)
{
    return worst_element(broken_frame(0, pbs::Outcome::finished, positions, mesh_metrics.volume_ratios(positions)));
}

analysis::FrameValues values_of(const RestMesh& rest, const analysis::MeshMetrics& mesh_metrics,
                                const pbs::Positions& positions)
{
    return {mesh_metrics.measure(positions), mesh_metrics.volume_ratios(positions).maxCoeff<Eigen::PropagateNaN>(),
            analysis::largest_edge_strain(rest.mesh().rest, rest.edges(), positions)};
}

using analysis::Columns;

const Columns<analysis::FrameValues> value_columns =
    analysis::within(&analysis::FrameValues::metrics, frame_metric_columns()) +
    MEMBER_COLUMNS(analysis::FrameValues, j_max, edge_strain_max);

const Columns<analysis::MeasuredFrame> columns =
    analysis::Columns<analysis::MeasuredFrame>{{"frame", &analysis::MeasuredFrame::name}} +
    analysis::within(&analysis::MeasuredFrame::values, value_columns);

struct MeasuredRow {
    analysis::MeasuredFrame frame;
    std::optional<ReferenceError> error;
};
const Columns<MeasuredRow> error_columns =
    analysis::within(&MeasuredRow::frame, columns) +
    analysis::within(&MeasuredRow::error,
                     Columns<ReferenceError>{{"reference", &ReferenceError::reference},
                                             {"error_l2_pct", &ReferenceError::l2_pct},
                                             {"error_joint_pct", &ReferenceError::joint_pct},
                                             {"error_linf_m", &ReferenceError::linf_m},
                                             {"skin_rms_mm", &ReferenceError::skin_rms_mm},
                                             {"own_error_pct", &ReferenceError::own_error_pct},
                                             {"error_above_own_error", &ReferenceError::above_own_error}});

void print_row(const analysis::MeasuredFrame& frame)
{
    const analysis::FrameMetrics& m = frame.values.metrics;
    fmt::print("{:<32} {:>14.6f} {:>14.6f} {:>9} {:>10.4f} {:>10.4f} {:>12.6f} {:>12.6f}\n", frame.name,
               m.volume_change_pct, m.volume_abs_change_pct, m.inverted_tets, m.j_min, frame.values.j_max,
               m.stretch_rms, frame.values.edge_strain_max);
}

void print_errors(const std::vector<MeasuredRow>& rows)
{
    fmt::print("\n{:<32} {:>14} {:>15} {:>14} {:>12} {:>13}  {}\n", "frame", "error_l2_pct", "error_joint_pct",
               "error_linf_m", "skin_rms_mm", "own_error_pct", "reference");
    const auto text_of = [](const std::optional<double>& value) { return value ? fmt::format("{:.6f}", *value) : "-"; };
    for (const auto& [frame, error] : rows) {
        const char* verdict = !error->above_own_error   ? ""
                              : *error->above_own_error ? ": above its own error"
                                                        : ": within its own error";
        fmt::print("{:<32} {:>14.6f} {:>15} {:>14.9f} {:>12.6f} {:>13}  {}{}\n", frame.name, error->l2_pct,
                   text_of(error->joint_pct), error->linf_m, error->skin_rms_mm, text_of(error->own_error_pct),
                   error->reference, verdict);
    }
}

}  // namespace

int measure_tets(const MeasureArguments& arguments)
{
    const std::vector<std::string> paths = frame_files(arguments.frames, {.any_step = arguments.any_step}),
                                   names = frame_names(paths);
    require_separate_outputs(arguments, paths);
    const pbs::MeshReading reading = pbs::read_tet_mesh(arguments.rest, false);
    warn(pbs::remarks_on(arguments.rest, reading));
    const RestMesh rest(reading, arguments.displacement);
    const analysis::MeshMetrics mesh_metrics(rest.mesh().rest, rest.mesh().tets);
    const analysis::SkinErrorMetrics skin(rest.mesh().rest, rest.mesh().tets);
    const std::vector<FileReference> references = file_references(arguments.reference, paths.size(), rest);
    std::vector<MeasuredRow> rows;
    bool is_displaced = false, moves = false;
    if (!arguments.quiet)
        fmt::print("{:<32} {:>14} {:>14} {:>9} {:>10} {:>10} {:>12} {:>12}\n", "frame", "volume %", "volume abs %",
                   "inverted", "j_min", "j_max", "stretch rms", "edge strain");
    const auto measure_frame = [&](std::size_t i) {
        const pbs::Positions positions = rest.read_frame(paths[i], &is_displaced);
        moves = moves || !are_at_rest(positions, rest.mesh().rest);
        const MeasuredRow& row =
            rows.emplace_back(MeasuredRow{{names[i], values_of(rest, mesh_metrics, positions)}, {}});
        if (!references.empty())
            rows.back().error = references[references.size() == 1 ? 0 : i].error_of(positions, skin);
        if (!arguments.quiet) print_row(row.frame);
        if (row.frame.values.metrics.inverted_tets > 0)
            fmt::print(stderr, "pbskin: {}: {}\n", paths[i], worst_of(mesh_metrics, positions));
        return row.frame.values;
    };
    const MeasuredFrames measured = measure_each(arguments, paths, names, measure_frame);
    if (is_displaced)
        warn({fmt::format(
            "{}: points = those of the rest mesh: deformed by the field `displacement`, as of exported references",
            paths.front())});
    if (!moves && !rows.empty() && measured.refused.empty())
        warn(
            {fmt::format("{}: nothing moves: each frame has the points of the rest mesh; --displacement names a vector "
                         "that deforms them",
                         arguments.rest)});
    if (!references.empty() && !arguments.quiet) print_errors(rows);
    if (!arguments.csv.empty())
        (references.empty() ? table_of(columns, measured.frames) : table_of(error_columns, rows)).write(arguments.csv);
    return reported(arguments, measured,
                    references.empty() ? "pbskin explain volume_change_pct explains a column"
                                       : "pbskin explain error_joint_pct explains a column");
}

}  // namespace experiments
