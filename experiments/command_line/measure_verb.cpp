// pbskin measure REST FRAME... [--reference FILE] [--csv FILE] [--junit FILE] [--max-volume-change PCT]...: applies the metrics to frames
// of any program.
//   pbskin measure rest.msh 'out/frame_%04d.vtu' --max-volume-change 0.5 --max-inverted 0 --junit volume.xml
//   pbskin measure kit/bodies/limb.vtu mine.vtu --reference kit/limb_twist_60/smooth.vtu

#include "analysis/check/check.hpp"
#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/metrics/skin_error.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/command_line/plain_vtu.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/run/metrics_table.hpp"
#include "experiments/verdicts/check/check_run.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/geometry/topology.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace experiments {
namespace {

using Corners = std::array<int, 4>;

std::vector<Corners> sorted_corners(const pbs::Tets& tets)
{
    std::vector<Corners> all;
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
        Corners corners = {tets(t, 0), tets(t, 1), tets(t, 2), tets(t, 3)};
        std::sort(corners.begin(), corners.end());
        all.push_back(corners);
    }
    std::sort(all.begin(), all.end());
    return all;
}

// The ratio of a length in one unit to the same length in another. The inverse ratio is tested too.
struct Unit {
    double factor;
    const char* what;
};
constexpr std::array units = {Unit{10.0, "millimetres against centimetres"}, Unit{100.0, "centimetres against metres"},
                              Unit{1000.0, "millimetres against metres"},    Unit{39.3701, "inches against metres"},
                              Unit{3.28084, "feet against metres"},          Unit{25.4, "millimetres against inches"},
                              Unit{2.54, "centimetres against inches"}};

// The median edge of a body is never stretched or compressed by a factor of two, and hardly by exactly the factor of a unit.
constexpr double nearness = 0.1, twofold = 2.0;

constexpr double same_point = 1e-6;  // of the body's diagonal: coordinates in single precision

// A deformed shape from a file.
struct FileShape {
    pbs::Positions positions;  // [m], #V x 3
    bool is_at_rest = false;   // the file's points are those of the rest mesh, and it has no displacement
    PlainFields fields = {};   // of a .vtu in plain text, in the order of the rest mesh's vertices
};

// Frames that another program has written. They must have the vertices of the rest mesh, in the same order and in the same unit.
//   const RestMesh rest(pbs::read_tet_mesh("rest.msh", false));
//   const pbs::Positions positions = rest.read_frame("frame_0001.vtu");
class RestMesh {
public:
    explicit RestMesh(const pbs::MeshReading& reading)
        : mesh_(reading.mesh),
          file_vertex_(reading.file_vertex),
          file_vertices_(reading.file_vertices),
          edges_(pbs::edges_of(mesh_.tets)),
          corners_(sorted_corners(mesh_.tets.unaryExpr([this](int vertex) { return file_vertex_[vertex]; })))
    {
    }

    // [m], #V x 3. InputError for another number of vertices, for other tets, and for positions in another unit. The order of the tets and
    // of their corners may differ, for readers and exporters change it; the metrics take that of the rest mesh. Where the file's points are
    // those of the rest mesh, a .vtu in plain text may state the shape as a field `displacement` [m], as exported references do.
    pbs::Positions read_frame(const std::string& path) const
    {
        const pbs::Positions points = points_in(path);
        return is_at_rest(points) ? shape_of(path, points).positions : points;
    }
    FileShape read_shape(const std::string& path) const { return shape_of(path, points_in(path)); }  // the same with the file's fields

    const pbs::TetMesh& mesh() const { return mesh_; }
    const pbs::Edges& edges() const { return edges_; }

private:
    pbs::Positions points_in(const std::string& path) const
    {
        const pbs::TetMesh frame = pbs::read_tet_frame(path);
        if (frame.rest.rows() != file_vertices_)
            throw pbs::InputError(
                path, 0, "vertices", std::to_string(frame.rest.rows()),
                fmt::format("expected the rest mesh's {}: exporters that join, split or leave out points change the number",
                            file_vertices_));
        require_same_tets(path, frame.tets);
        pbs::Positions points = frame.rest(file_vertex_, Eigen::all);
        require_same_units(path, points);
        return points;
    }

    bool is_at_rest(const pbs::Positions& points) const
    {
        const double diagonal_m = (mesh_.rest.colwise().maxCoeff() - mesh_.rest.colwise().minCoeff()).norm();
        return (points - mesh_.rest).cwiseAbs().maxCoeff() <= same_point * diagonal_m;
    }

    FileShape shape_of(const std::string& path, const pbs::Positions& points) const
    {
        FileShape shape{.positions = points, .is_at_rest = is_at_rest(points), .fields = read_plain_fields(path)};
        for (auto& [name, values] : shape.fields.of_points) {
            if (values.rows() != file_vertices_)
                throw pbs::InputError(path, 0, name, fmt::format("{} rows", values.rows()), fmt::format("expected {}", file_vertices_));
            values = values(file_vertex_, Eigen::all).eval();
        }
        const auto displacement = shape.fields.of_points.find("displacement");
        if (!shape.is_at_rest || displacement == shape.fields.of_points.end()) return shape;
        if (displacement->second.cols() != 3)
            throw pbs::InputError(path, 0, "components of displacement", std::to_string(displacement->second.cols()), "expected 3");
        shape.positions = mesh_.rest + displacement->second;
        shape.is_at_rest = false;
        return shape;
    }

    void require_same_tets(const std::string& path, const pbs::Tets& tets) const
    {
        const std::vector<Corners> corners = sorted_corners(tets);
        if (corners.size() != corners_.size())
            throw pbs::InputError(path, 0, "tets", std::to_string(corners.size()),
                                  fmt::format("expected the rest mesh's {}", corners_.size()));
        if (const auto other = std::ranges::mismatch(corners_, corners).in1; other != corners_.end())
            throw pbs::InputError(path, 0, "tets", "",
                                  fmt::format("expected the rest mesh's, on the same vertices; it has a tet on {}, and this frame "
                                              "does not: was the order of the vertices kept on export?",
                                              fmt::join(*other, " ")));
    }

    void require_same_units(const std::string& path, const pbs::Positions& positions) const
    {
        const double ratio = analysis::median_edge_ratio(mesh_.rest, edges_, positions);
        if (ratio < twofold && ratio > 1.0 / twofold) return;
        for (const Unit& unit : units)
            for (const double factor : {unit.factor, 1.0 / unit.factor})
                if (std::abs(ratio / factor - 1.0) <= nearness)
                    throw pbs::InputError(path, 0, "median edge", fmt::format("{:.4g} times the rest mesh's", ratio),
                                          fmt::format("expected the rest mesh's unit; a factor of {:.5g}, as of {}{}", factor, unit.what,
                                                      factor < 1.0 ? " (the other way round)" : ""));
    }

    pbs::TetMesh mesh_;
    std::vector<int> file_vertex_;  // of the rest mesh's file, #V
    int file_vertices_ = 0;
    pbs::Edges edges_;
    std::vector<Corners> corners_;  // each tet's in ascending order as the file numbers them, and the tets sorted
};

// A frame against a reference.
struct ReferenceError {
    std::string reference;  // the name of its file
    double l2_pct = 0.0;
    std::optional<double> joint_pct = {};  // the reference's file does not state the vertices that Eq. 2 blends
    double linf_m = 0.0, skin_rms_mm = 0.0;
    std::optional<double> own_error_pct = {};  // U, the reference's own error in the norm of joint_pct; nothing: not known
    std::optional<bool> above_own_error = {};  // otherwise the reference's own error may be the whole difference
};

// A reference from a file: any frame, or one that `pbskin references export` has written, whose fields state where errors are measured.
class FileReference {
public:
    FileReference(const std::string& name, const RestMesh& rest, FileShape shape)
        : name_(name),
          rest_(rest.mesh()),
          shape_(std::move(shape)),
          at_tips_(flags("at_tips")),
          has_joints_(shape_.fields.of_points.contains("blended") && shape_.fields.of_points.contains("bone_distance_m")),
          norms_(domain())
    {
    }

    ReferenceError error_of(const pbs::Positions& positions, const analysis::SkinErrorMetrics& skin) const
    {
        const analysis::ErrorNorms norms = norms_.measure(positions, shape_.positions, at_tips_);
        ReferenceError error{.reference = name_, .l2_pct = norms.l2_pct, .linf_m = norms.linf_m};
        if (has_joints_) error.joint_pct = norms.joint_pct;
        error.skin_rms_mm = skin.measure(positions, shape_.positions, at_tips_).rms_mm;
        if (const auto own = shape_.fields.facts.find("own_error_pct"); own != shape_.fields.facts.end()) error.own_error_pct = own->second;
        if (error.joint_pct && error.own_error_pct) error.above_own_error = *error.joint_pct > *error.own_error_pct;
        return error;
    }

    bool is_at_rest() const { return shape_.is_at_rest; }

private:
    std::vector<bool> flags(const std::string& field) const
    {
        std::vector<bool> set(rest_.rest.rows(), false);
        if (const auto values = shape_.fields.of_points.find(field); values != shape_.fields.of_points.end())
            for (std::size_t v = 0; v < set.size(); ++v) set[v] = values->second(static_cast<Eigen::Index>(v), 0) != 0.0;
        return set;
    }

    analysis::ErrorDomain domain() const
    {
        analysis::ErrorDomain domain{rest_.rest, rest_.tets, {}, {}, {}};
        if (!has_joints_) return domain;
        const std::vector<bool> blended = flags("blended");
        for (std::size_t v = 0; v < blended.size(); ++v)
            if (blended[v]) domain.blended.push_back(static_cast<int>(v));
        domain.bone_distance_m = shape_.fields.of_points.at("bone_distance_m").col(0);
        return domain;
    }

    std::string name_;
    const pbs::TetMesh& rest_;
    FileShape shape_;
    std::vector<bool> at_tips_;  // of creases, where nothing is measured, #V
    bool has_joints_ = false;
    analysis::ErrorMetrics norms_;
};

// One for all frames, or one for each. InputError for another number of them, and if all are the rest mesh itself.
std::vector<FileReference> file_references(const std::string& argument, std::size_t frames, const RestMesh& rest)
{
    std::vector<FileReference> references;
    if (argument.empty()) return references;
    const std::vector<std::string> paths = frame_files({argument}), names = frame_names(paths);
    if (paths.size() != 1 && paths.size() != frames)
        throw pbs::InputError(argument, 0, "references", std::to_string(paths.size()),
                              fmt::format("expected one, or one for each of the {} frames", frames));
    for (std::size_t i = 0; i < paths.size(); ++i) references.emplace_back(names[i], rest, rest.read_shape(paths[i]));
    if (std::ranges::all_of(references, &FileReference::is_at_rest))
        throw pbs::InputError(
            paths.front(), 0, "displacement", "",
            "missing: its points are those of the rest mesh, so that it states no deformed shape; expected deformed points, "
            "or the field `displacement` in plain text as `pbskin references export` writes it");
    return references;
}

struct MeasureArguments {
    std::string rest, csv, reference;
    std::vector<std::string> frames;
    std::vector<analysis::FrameBound> bounds = analysis::known_frame_bounds();
    CheckReports reports;
};

// The worst tet of a frame with inverted tets. The reader refuses frames that are not finite.
std::string worst_of(const analysis::MeshMetrics& mesh_metrics, const pbs::Positions& positions)
{
    return worst_element(broken_frame(0, pbs::Outcome::finished, positions, mesh_metrics.volume_ratios(positions)));
}

analysis::FrameValues values_of(const RestMesh& rest, const analysis::MeshMetrics& mesh_metrics, const pbs::Positions& positions)
{
    return {mesh_metrics.measure(positions), mesh_metrics.volume_ratios(positions).maxCoeff<Eigen::PropagateNaN>(),
            analysis::largest_edge_strain(rest.mesh().rest, rest.edges(), positions)};
}

using analysis::Columns;

const Columns<analysis::FrameValues> value_columns = analysis::within(&analysis::FrameValues::metrics, frame_metric_columns()) +
                                                     MEMBER_COLUMNS(analysis::FrameValues, j_max, edge_strain_max);

const Columns<analysis::MeasuredFrame> columns = analysis::Columns<analysis::MeasuredFrame>{{"frame", &analysis::MeasuredFrame::name}} +
                                                 analysis::within(&analysis::MeasuredFrame::values, value_columns);

struct MeasuredRow {
    analysis::MeasuredFrame frame;
    std::optional<ReferenceError> error;
};
const Columns<MeasuredRow> error_columns =
    analysis::within(&MeasuredRow::frame, columns) +
    analysis::within(&MeasuredRow::error, Columns<ReferenceError>{{"reference", &ReferenceError::reference},
                                                                  {"error_l2_pct", &ReferenceError::l2_pct},
                                                                  {"error_joint_pct", &ReferenceError::joint_pct},
                                                                  {"error_linf_m", &ReferenceError::linf_m},
                                                                  {"skin_rms_mm", &ReferenceError::skin_rms_mm},
                                                                  {"own_error_pct", &ReferenceError::own_error_pct},
                                                                  {"error_above_own_error", &ReferenceError::above_own_error}});

void print_row(const analysis::MeasuredFrame& frame)
{
    const analysis::FrameMetrics& m = frame.values.metrics;
    fmt::print("{:<32} {:>14.6f} {:>14.6f} {:>9} {:>10.4f} {:>10.4f} {:>12.6f} {:>12.6f}\n", frame.name, m.volume_change_pct,
               m.volume_abs_change_pct, m.inverted_tets, m.j_min, frame.values.j_max, m.stretch_rms, frame.values.edge_strain_max);
}

void print_errors(const std::vector<MeasuredRow>& rows)
{
    fmt::print("\n{:<32} {:>14} {:>15} {:>14} {:>12} {:>13}  {}\n", "frame", "error_l2_pct", "error_joint_pct", "error_linf_m",
               "skin_rms_mm", "own_error_pct", "reference");
    const auto text_of = [](const std::optional<double>& value) { return value ? fmt::format("{:.6f}", *value) : "-"; };
    for (const auto& [frame, error] : rows) {
        const char* verdict = !error->above_own_error ? "" : *error->above_own_error ? ": above its own error" : ": within its own error";
        fmt::print("{:<32} {:>14.6f} {:>15} {:>14.9f} {:>12.6f} {:>13}  {}{}\n", frame.name, error->l2_pct, text_of(error->joint_pct),
                   error->linf_m, error->skin_rms_mm, text_of(error->own_error_pct), error->reference, verdict);
    }
}

// Prints the bounds that do not hold in a frame on stderr. Returns whether all hold.
bool report_broken(const std::vector<analysis::FrameBound>& bounds, const std::string& path, const analysis::MeasuredFrame& frame)
{
    bool all_hold = true;
    for (const analysis::FrameBound& bound : bounds) {
        const std::string broken = broken_text(bound, frame.values);
        if (!broken.empty()) fmt::print(stderr, "pbskin: {}: {}\n", path, broken);
        all_hold = all_hold && broken.empty();
    }
    return all_hold;
}

// A frame that cannot be read or does not fit is reported, and the others are measured.
int measure(const MeasureArguments& arguments, bool quiet)
{
    const pbs::Stopwatch stopwatch;
    std::for_each(arguments.bounds.begin(), arguments.bounds.end(), analysis::require_meaningful);
    if (!arguments.csv.empty()) analysis::require_writable(arguments.csv);
    require_writable(arguments.reports);
    const std::vector<std::string> paths = frame_files(arguments.frames), names = frame_names(paths);
    const pbs::MeshReading reading = pbs::read_tet_mesh(arguments.rest, false);
    warn(pbs::remarks_on(arguments.rest, reading));
    const RestMesh rest(reading);
    const analysis::MeshMetrics mesh_metrics(rest.mesh().rest, rest.mesh().tets);
    const analysis::SkinErrorMetrics skin(rest.mesh().rest, rest.mesh().tets);
    const std::vector<FileReference> references = file_references(arguments.reference, paths.size(), rest);
    std::vector<MeasuredRow> rows;
    std::vector<analysis::MeasuredFrame> frames;
    std::vector<analysis::RefusedFrame> refused;
    bool all_hold = true;
    if (!quiet)
        fmt::print("{:<32} {:>14} {:>14} {:>9} {:>10} {:>10} {:>12} {:>12}\n", "frame", "volume %", "volume abs %", "inverted", "j_min",
                   "j_max", "stretch rms", "edge strain");
    for (std::size_t i = 0; i < paths.size(); ++i) {
        try {
            const pbs::Positions positions = rest.read_frame(paths[i]);
            frames.push_back({names[i], values_of(rest, mesh_metrics, positions)});
            rows.push_back({frames.back(), {}});
            if (!references.empty()) rows.back().error = references[references.size() == 1 ? 0 : i].error_of(positions, skin);
            if (!quiet) print_row(frames.back());
            if (frames.back().values.metrics.inverted_tets > 0)
                fmt::print(stderr, "pbskin: {}: {}\n", paths[i], worst_of(mesh_metrics, positions));
            all_hold = report_broken(arguments.bounds, paths[i], frames.back()) && all_hold;
        } catch (const pbs::InputError& error) {
            fmt::print(stderr, "pbskin: {}\n", error.what());
            refused.push_back({names[i], error.what()});
        }
    }
    if (!references.empty() && !quiet) print_errors(rows);
    if (!arguments.csv.empty()) (references.empty() ? table_of(columns, frames) : table_of(error_columns, rows)).write(arguments.csv);
    const std::string suite = std::filesystem::path(arguments.rest).filename().string();
    write_reports(arguments.reports, {frame_suite(suite, arguments.bounds, frames, refused, stopwatch.seconds())});
    if (!refused.empty()) return exit_input;
    say_next(references.empty() ? "pbskin explain volume_change_pct explains a column; --max-volume-change 0.5 holds it to a bound"
                                : "pbskin explain error_joint_pct explains a column");
    return all_hold ? exit_finished : exit_bound;
}

}  // namespace

void add_measure_verb(CommandLine& line)
{
    auto arguments = std::make_shared<MeasureArguments>();
    CLI::App* verb = line.add("measure", "applies the metrics to frames of any program; exit 1 if a bound fails",
                              "pbskin measure rest.vtu 'out/frame_%04d.vtu' --max-volume-change 0.5 --max-inverted 0",
                              [&common = line.common, arguments] { return measure(*arguments, common.quiet); });
    verb->add_option("rest", arguments->rest, "rest tet mesh: .msh .vtu .vtk .mesh .tobj .ele")->required();
    verb->add_option(
            "frames", arguments->frames,
            "deformed frames with the same vertices in the same order: files, 'frame_%04d.vtu', 'frame_*.vtu' or a folder with one "
            "sequence, in which no number may be missing")
        ->required();
    verb->add_option(
            "--reference", arguments->reference,
            "print the frames' errors against this deformed frame, or against one for each frame ('ref_%04d.vtu'); one that `pbskin "
            "references export` wrote brings the vertices at the joints and its own error U")
        ->type_name("FILE");
    verb->add_option("--csv", arguments->csv, "write the values as CSV");
    for (analysis::FrameBound& bound : arguments->bounds) verb->add_option(bound.option, bound.value, bound.meaning);
    verb->add_option("--junit", arguments->reports.junit, "write a JUnit report with one test case per bound");
    verb->add_flag("--github", arguments->reports.github, "annotations for GitHub on stdout (the default where GITHUB_ACTIONS is true)");
}

}  // namespace experiments
