#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/command_line/measure/measured_frames.hpp"
#include "experiments/command_line/measure/rest_surface.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "experiments/rigs/surface_reader.hpp"
#include "experiments/trial/trial.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace experiments {
namespace {

// A frame of all closed shells.
struct SurfaceRow {
    std::string frame;
    std::optional<double> time_s = {};  // of an animation, from its first key
    double volume_m3 = 0.0, volume_change_pct = 0.0;
    double volume_abs_change_pct = 0.0;  // 100 sum |V_s - V0_s| / V0 over the shells s
    std::optional<int> self_intersections = {};
    double edge_strain_max = 0.0;
};

struct ShellRow {
    std::string frame;
    int shell = 0;  // from 1, in the order of the file
    std::string mesh, role;
    double volume_m3 = 0.0, volume_change_pct = 0.0;
};

std::string text_of(const std::optional<int>& count)
{
    return count ? std::to_string(*count) : "-";
}

const char* role_name(analysis::ShellRole role)
{
    constexpr const char* names[] = {"body", "cavity", "nested", "flat", "copy", "open"};
    return names[static_cast<int>(role)];
}

const analysis::Columns<SurfaceRow> time_column = {{"time_s", &SurfaceRow::time_s}};
const analysis::Columns<SurfaceRow> frame_column = {{"frame", &SurfaceRow::frame}};
const analysis::Columns<SurfaceRow> surface_columns = {{"volume_m3", &SurfaceRow::volume_m3},
                                                       {"volume_change_pct", &SurfaceRow::volume_change_pct},
                                                       {"volume_abs_change_pct", &SurfaceRow::volume_abs_change_pct},
                                                       {"self_intersections", &SurfaceRow::self_intersections},
                                                       {"edge_strain_max", &SurfaceRow::edge_strain_max}};
const analysis::Columns<ShellRow> shell_columns = {
    {"frame", &ShellRow::frame},         {"shell", &ShellRow::shell},
    {"mesh", &ShellRow::mesh},           {"role", &ShellRow::role},
    {"volume_m3", &ShellRow::volume_m3}, {"volume_change_pct", &ShellRow::volume_change_pct}};

// Measures the closed shells of a surface frame by frame.
class SurfaceMeasurement {
public:
    SurfaceMeasurement(const MeasureArguments& arguments, const RestSurface& rest)
        : arguments_(arguments), rest_(rest), volumes_m3_(rest.shells().volumes(rest.points()))
    {
        warn(rest.remarks());
        if (arguments.quiet) return;
        const auto capped =
            std::ranges::count_if(rest.shells().counted(), [&](int s) { return !rest.shells().all()[s].caps.empty(); });
        fmt::print("{}: {} closed shell{}{}, {:.6g} m^3, {} pairs of triangles meet\n", arguments.rest,
                   volumes_m3_.size(), volumes_m3_.size() == 1 ? "" : "s",
                   capped > 0 ? fmt::format(" ({} by caps)", capped) : "", volumes_m3_.sum(),
                   text_of(rest.self_intersections(rest.points())));
        fmt::print("{:<32} {:>14} {:>14} {:>14} {:>18} {:>12}\n", "frame", "volume m^3", "volume %", "volume abs %",
                   "self-intersections", "edge strain");
    }

    analysis::FrameValues measure(const std::string& name, const pbs::Positions& points,
                                  std::optional<double> time_s = {})
    {
        const Eigen::VectorXd volumes_m3 = rest_.shells().volumes(points), changes_m3 = volumes_m3 - volumes_m3_;
        const double rest_m3 = volumes_m3_.sum();
        const SurfaceRow row{name,
                             time_s,
                             volumes_m3.sum(),
                             100.0 * changes_m3.sum() / rest_m3,
                             100.0 * changes_m3.cwiseAbs().sum() / rest_m3,
                             rest_.self_intersections(points),
                             analysis::largest_edge_strain(rest_.points(), rest_.edges(), points)};
        add_shells(name, volumes_m3);
        if (const double gap_m = rest_.shells().largest_gap_m(points); gap_m > gap_m_) {
            gap_m_ = gap_m;
            gap_frame_ = name;
        }
        moves_ = moves_ || points != rest_.points();
        const double bound_pct = 100.0 * rest_.shells().cap_bound_m3(points) / rest_m3;
        if (bound_pct > cap_bound_pct_) {
            cap_bound_pct_ = bound_pct;
            cap_frame_ = name;
        }
        if (!arguments_.quiet)
            fmt::print("{:<32} {:>14.6g} {:>14.6f} {:>14.6f} {:>18} {:>12.6f}\n", name, row.volume_m3,
                       row.volume_change_pct, row.volume_abs_change_pct, text_of(row.self_intersections),
                       row.edge_strain_max);
        rows_.push_back(row);
        const analysis::FrameValues values = {
            .metrics = {.volume_change_pct = row.volume_change_pct, .volume_abs_change_pct = row.volume_abs_change_pct},
            .edge_strain_max = row.edge_strain_max,
            .self_intersections =
                row.self_intersections ? *row.self_intersections : std::numeric_limits<double>::quiet_NaN()};
        note_undecided_limits(name, values, bound_pct);
        return values;
    }

    // Prints the shells, writes the tables, and warns of what is seen only in all frames together.
    void finish(bool has_times, MeasuredFrames& measured) const
    {
        if (cap_bound_pct_ > 0.0)
            warn(
                {fmt::format("{}: if what lies in the holes moves with their rims, the changes of the volume are right "
                             "to {:.2g} points of a per "
                             "cent, the widest in frame {} (the area of the caps times the distance of the rims from a "
                             "rigid motion)",
                             arguments_.rest, cap_bound_pct_, cap_frame_)});
        measured.properties = {
            {"measured_share_of_area_pct", fmt::format("{:.1f}", 100.0 * rest_.shells().counted_share())},
            {"cap_bound_pct", fmt::format("{:.4g}", cap_bound_pct_)}};
        measured.not_judged = rest_.not_whole();
        if (measured.not_judged.empty() && !breaks_for_all_) measured.not_judged = undecided_;
        if (!arguments_.quiet && volumes_m3_.size() > 1) print_shells();
        if (!arguments_.csv.empty())
            table_of(has_times ? frame_column + time_column + surface_columns : frame_column + surface_columns, rows_)
                .write(arguments_.csv);
        if (!arguments_.shells.empty()) table_of(shell_columns, shell_rows_).write(arguments_.shells);
        const pbs::Positions& rest = rest_.points();
        const double gap_pct = 100.0 * gap_m_ / pbs::diagonal_m(rest);
        constexpr double least_gap_pct = 0.01;
        if (gap_pct > least_gap_pct)
            warn(
                {fmt::format("{}: gap between joined points = {:.2g} % of the size in frame {}: a seam of the surface "
                             "opens, over which its "
                             "volume is measured as if it were closed",
                             arguments_.rest, gap_pct, gap_frame_)});
        if (!moves_ && !rows_.empty())
            warn(
                {fmt::format("{}: nothing moves: each frame has the points of the rest mesh; a skin or a cache that "
                             "another program applies is "
                             "not in such files (export the deformed surface, or measure the rigged model alone)",
                             arguments_.rest)});
    }

private:
    // Limits that hold for some surfaces in the holes and not for others. One that holds for none in some frame is
    // decided by that.
    void note_undecided_limits(const std::string& name, const analysis::FrameValues& values, double bound_pct)
    {
        const auto moved_by = [&](double pct) {
            const auto moved = [&](double change_pct) {
                return std::copysign(std::max(0.0, std::abs(change_pct) + pct), change_pct);
            };
            analysis::FrameValues other = values;
            other.metrics.volume_change_pct = moved(values.metrics.volume_change_pct);
            other.metrics.volume_abs_change_pct = moved(values.metrics.volume_abs_change_pct);
            return other;
        };
        const analysis::FrameValues least = moved_by(-bound_pct), most = moved_by(bound_pct);
        for (const analysis::FrameBound& bound : arguments_.bounds) {
            const bool holds_for_some = broken_text(bound, least).empty(),
                       holds_for_all = broken_text(bound, most).empty();
            breaks_for_all_ = breaks_for_all_ || !holds_for_some;
            if (undecided_.empty() && holds_for_some && !holds_for_all)
                undecided_ = fmt::format(
                    "in frame {} {} holds for some surfaces that could close the holes and not for others (they change "
                    "the volume by at "
                    "most {:.2g} %)",
                    name, bound.option, bound_pct);
        }
    }

    void add_shells(const std::string& name, const Eigen::VectorXd& volumes_m3)
    {
        const auto& counted = rest_.shells().counted();
        for (std::size_t c = 0; c < counted.size(); ++c) {
            const analysis::Shell& shell = rest_.shells().all()[counted[c]];
            const auto v = static_cast<Eigen::Index>(c);
            shell_rows_.push_back({name, counted[c] + 1, rest_.mesh_of(shell), role_name(shell.role), volumes_m3(v),
                                   100.0 * (volumes_m3(v) - volumes_m3_(v)) / volumes_m3_(v)});
        }
    }

    // The shells with the largest volumes, and the range of each over the frames.
    void print_shells() const
    {
        constexpr std::size_t most = 20;
        std::vector<std::size_t> order(static_cast<std::size_t>(volumes_m3_.size()));
        for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
        std::ranges::stable_sort(order, std::ranges::greater(),
                                 [&](std::size_t c) { return std::abs(volumes_m3_(c)); });
        fmt::print("\n{:<32} {:>14} {:>14} {:>14}  {}\n", "shell", "rest m^3", "lowest %", "highest %", "counts as");
        for (std::size_t i = 0; i < std::min(order.size(), most) && !shell_rows_.empty(); ++i) {
            double low = std::numeric_limits<double>::infinity(), high = -low;
            const ShellRow& first = shell_rows_[order[i]];  // of the shell: each frame has a row for each shell
            for (std::size_t r = order[i]; r < shell_rows_.size(); r += order.size()) {
                low = std::min(low, shell_rows_[r].volume_change_pct);
                high = std::max(high, shell_rows_[r].volume_change_pct);
            }
            fmt::print("{:<32} {:>14.6g} {:>14.6f} {:>14.6f}  {}\n", fmt::format("{} {}", first.shell, first.mesh),
                       volumes_m3_(static_cast<Eigen::Index>(order[i])), low, high, first.role);
        }
        if (order.size() > most) fmt::print("and {} smaller shells (--shells FILE has all)\n", order.size() - most);
    }

    const MeasureArguments& arguments_;
    const RestSurface& rest_;
    Eigen::VectorXd volumes_m3_;  // at rest, of each closed shell
    std::vector<SurfaceRow> rows_;
    std::vector<ShellRow> shell_rows_;
    double gap_m_ = 0.0, cap_bound_pct_ = 0.0;
    std::string gap_frame_, cap_frame_, undecided_;
    bool moves_ = false, breaks_for_all_ = false;
};

// The animation of that name, or else the one that `pbskin try` takes. InputError for a model without any.
const pbs::RigAnimation& animation_of(const MeasureArguments& arguments, const pbs::Rig& rig)
{
    if (!arguments.animation.empty()) return *pbs::find_animation(rig, arguments.animation);
    TrialOptions options;
    options.model = arguments.rest;
    TrialScene choice;
    const pbs::RigAnimation* taken = moving_animation(options, rig, pbs::make_rigged_body(rig, nullptr, 1.0), choice);
    warn(choice.remarks.notes);
    if (taken) return *taken;
    const auto moves_morphs = [](const pbs::RigAnimation& animation) {
        return std::ranges::any_of(animation.nodes,
                                   [](const pbs::NodeTracks& tracks) { return !tracks.morph_weights.empty(); });
    };
    if (const auto first = std::ranges::find_if(rig.animations, moves_morphs); first != rig.animations.end())
        return *first;
    if (!rig.animations.empty()) return rig.animations.front();
    warn(rig.remarks);
    throw pbs::InputError(arguments.rest, 0, "animations", "0",
                          "expected one that moves nodes, joints or morph targets of glTF, to measure along it; other "
                          "deformed surfaces are measured as "
                          "frames (pbskin measure REST FRAME...)");
}

std::vector<NamedPoints> meshes_of(const pbs::RiggedBody& body)
{
    std::vector<NamedPoints> meshes;
    Eigen::Index first = 0;
    for (const pbs::RigMesh& mesh : body.binding.meshes) {
        meshes.push_back({mesh.name, first});
        first += mesh.points.rows();
    }
    return meshes;
}

analysis::Holes holes_of(const MeasureArguments& arguments)
{
    return arguments.closed_only ? analysis::Holes::leave_open : analysis::Holes::cap;
}

constexpr int most_frames_of_a_rig = 60;
constexpr const char* explanation = "pbskin explain volume_change_pct explains a column";

}  // namespace

int measure_surfaces(const MeasureArguments& arguments)
{
    const std::vector<std::string> paths = frame_files(arguments.frames,
                                                       {.any_step = arguments.any_step, .of_surfaces = true}),
                                   names = frame_names(paths);
    require_separate_outputs(arguments, paths);
    std::set<std::string> shown;  // remarks, which most frames share
    const auto warn_once = [&](const std::string& path, const std::vector<std::string>& remarks) {
        for (const std::string& remark : remarks)
            if (shown.insert(remark).second) warn({path + ": " + remark});
    };
    pbs::SurfaceReading reading = pbs::read_surface_frame(arguments.rest);
    warn_once(arguments.rest, reading.remarks);
    const RestSurface rest(arguments.rest, std::move(reading.mesh), holes_of(arguments));
    SurfaceMeasurement measurement(arguments, rest);
    MeasuredFrames measured = measure_each(arguments, paths, names, [&](std::size_t i) {
        std::vector<std::string> remarks;
        const pbs::Positions points = rest.read_frame(paths[i], arguments.displacement, remarks);
        warn_once(paths[i], remarks);
        return measurement.measure(names[i], points);
    });
    measurement.finish(false, measured);
    return reported(arguments, measured, explanation);
}

int measure_rig(const MeasureArguments& arguments)
{
    require_separate_outputs(arguments, {});
    const pbs::Rig rig = pbs::read_rig(arguments.rest);
    const pbs::RigAnimation& animation = animation_of(arguments, rig);
    const pbs::RiggedBody body = pbs::make_rigged_body(rig, &animation, 1.0);
    std::vector<std::string> remarks;
    for (const std::string& remark : body.remarks) remarks.push_back(arguments.rest + ": " + remark);
    warn(remarks);
    const RestSurface rest(arguments.rest, {body.surface, body.triangles}, holes_of(arguments), meshes_of(body));
    SurfaceMeasurement measurement(arguments, rest);
    const double duration_s = animation.end_s - animation.start_s;
    const double rate_hz =
        trial_rate_hz(duration_s, arguments.most_frames.value_or(most_frames_of_a_rig), arguments.rest);
    const pbs::MotionSampling sampling = {.rate_hz = rate_hz, .time_step_s = 1.0 / rate_hz};
    constexpr double slack_s =
        1e-6;  // the last frame of a motion that was divided may lie behind its end by a rounding
    const int last = pbs::frames_after_the_first(sampling, duration_s, slack_s, arguments.rest);
    std::vector<std::string> names, paths;
    for (int frame = 0; frame <= last; ++frame) {
        names.push_back(std::to_string(frame));
        paths.push_back(fmt::format("{}: frame {}", arguments.rest, frame));
    }
    pbs::Positions first = rest.points();  // with which an animation of a single pose is compared
    bool moves = false;
    MeasuredFrames measured = measure_each(arguments, paths, names, [&](std::size_t i) {
        const int frame = static_cast<int>(i);
        const pbs::Positions points = pbs::artist_frame(rig, body, animation, sampling, frame);
        if (frame == 0 && last > 0) first = points;
        moves = moves || points != first;
        return measurement.measure(names[i], points, frame * sampling.time_step_s);
    });
    if (!moves && measured.refused.empty())
        throw pbs::InputError(
            arguments.rest, 0, "animation", animation.name,
            "expected one that moves the surface; deformed surfaces can be measured as frames (pbskin measure REST "
            "FRAME...)");
    measurement.finish(true, measured);
    return reported(arguments, measured, explanation);
}

}  // namespace experiments
