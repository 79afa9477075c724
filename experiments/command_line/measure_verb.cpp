// pbskin measure REST FRAME... [--csv FILE] [--max-volume-change PCT]...: the ruler on anybody's result.
#include "analysis/csv_table.hpp"
#include "analysis/frame_metrics.hpp"
#include "experiments/command_line/verbs.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

namespace experiments {
namespace {

struct MeasureArguments {
    std::string rest, csv;
    std::vector<std::string> frames;
    std::optional<double> max_volume_change_pct, max_volume_abs_change_pct, min_j;
    std::optional<int> max_inverted_tets;
};

// The corners of each tet in ascending order: readers may turn a tet round, never give it other corners.
pbs::Tets corners_of(pbs::Tets tets)
{
    for (Eigen::Index t = 0; t < tets.rows(); ++t) std::sort(tets.row(t).begin(), tets.row(t).end());
    return tets;
}

pbs::Positions read_frame(const std::string& path, Eigen::Index vertices, const pbs::Tets& rest_corners)
{
    const pbs::TetMesh frame = pbs::read_tet_frame(path);
    const pbs::Positions& positions = frame.rest;
    if (positions.rows() != vertices)
        throw pbs::InputError(path, 0, "vertices", std::to_string(positions.rows()), fmt::format("expected the rest mesh's {}", vertices));
    if (frame.tets.rows() != rest_corners.rows() || corners_of(frame.tets) != rest_corners)
        throw pbs::InputError(path, 0, "tets", "", "expected the rest mesh's, in its order");
    return positions;
}

// Negated comparisons: a value that is not a number breaks every bound.
std::vector<std::string> broken_bounds(const analysis::FrameMetrics& metrics, const MeasureArguments& bounds)
{
    std::vector<std::string> broken;
    if (bounds.max_volume_change_pct && !(std::abs(metrics.volume_change_pct) <= *bounds.max_volume_change_pct))
        broken.push_back(
            fmt::format("|volume_change_pct| = {:.6g} > {:g}", std::abs(metrics.volume_change_pct), *bounds.max_volume_change_pct));
    if (bounds.max_volume_abs_change_pct && !(metrics.volume_abs_change_pct <= *bounds.max_volume_abs_change_pct))
        broken.push_back(
            fmt::format("volume_abs_change_pct = {:.6g} > {:g}", metrics.volume_abs_change_pct, *bounds.max_volume_abs_change_pct));
    if (bounds.max_inverted_tets && metrics.inverted_tets > *bounds.max_inverted_tets)
        broken.push_back(fmt::format("inverted_tets = {} > {}", metrics.inverted_tets, *bounds.max_inverted_tets));
    if (bounds.min_j && !(metrics.j_min >= *bounds.min_j))
        broken.push_back(fmt::format("j_min = {:.6g} < {:g}", metrics.j_min, *bounds.min_j));
    return broken;
}

int measure(const MeasureArguments& arguments)
{
    const pbs::TetMesh rest = pbs::read_tet_mesh(arguments.rest).mesh;
    const pbs::Tets rest_corners = corners_of(rest.tets);
    const analysis::Ruler ruler(rest.rest, rest.tets);
    analysis::CsvTable table(
        {"frame", "volume_change_pct", "volume_abs_change_pct", "inverted_tets", "mean_abs_j_minus_1", "j_min", "stretch_rms"});
    int status = exit_finished;
    fmt::print("{:<32} {:>14} {:>14} {:>9} {:>10} {:>12}\n", "frame", "volume %", "volume abs %", "inverted", "j_min", "stretch rms");
    for (const std::string& path : arguments.frames) {
        const analysis::FrameMetrics m = ruler.measure(read_frame(path, rest.rest.rows(), rest_corners));
        const std::string name = std::filesystem::path(path).filename().string();
        table.add_row({name, m.volume_change_pct, m.volume_abs_change_pct, m.inverted_tets, m.mean_abs_j_minus_1, m.j_min, m.stretch_rms});
        fmt::print("{:<32} {:>14.6f} {:>14.6f} {:>9} {:>10.4f} {:>12.6f}\n", name, m.volume_change_pct, m.volume_abs_change_pct,
                   m.inverted_tets, m.j_min, m.stretch_rms);
        for (const std::string& bound : broken_bounds(m, arguments)) {
            fmt::print(stderr, "pbskin: {}: {}\n", path, bound);
            status = exit_bound;
        }
    }
    if (!arguments.csv.empty()) table.write(arguments.csv);
    return status;
}

}  // namespace

void add_measure_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb = add_verb(app, common, "measure",
                              "the ruler on anybody's result: a rest tet mesh and deformed frames; exit 1 where a bound does not hold");
    auto arguments = std::make_shared<MeasureArguments>();
    verb->add_option("rest", arguments->rest, "rest tet mesh: .msh .vtu .vtk .mesh .ele")->required();
    verb->add_option("frames", arguments->frames, "deformed frames with the same vertices in the same order")->required();
    verb->add_option("--csv", arguments->csv, "write the figures as CSV");
    verb->add_option("--max-volume-change", arguments->max_volume_change_pct, "bound on |volume_change_pct| [%]");
    verb->add_option("--max-volume-abs-change", arguments->max_volume_abs_change_pct, "bound on volume_abs_change_pct [%]");
    verb->add_option("--max-inverted", arguments->max_inverted_tets, "bound on inverted_tets");
    verb->add_option("--min-j", arguments->min_j, "bound on j_min");
    verb->callback([&action, arguments] { action = [arguments] { return measure(*arguments); }; });
}

}  // namespace experiments
