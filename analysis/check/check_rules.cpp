#include "analysis/check/check.hpp"

#include "analysis/records/tables.hpp"
#include "analysis/records/toml_keys.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace analysis {
namespace {

using Names = std::vector<std::string>;

void require_known(const TomlKeys& keys, const char* key, const std::string& name, const Names& known,
                   const std::string& rule)
{
    if (std::count(known.begin(), known.end(), name)) return;
    keys.refuse(key, rule + (known.empty() ? "" : "; the nearest known one is " + pbs::nearest_name(name, known)));
}

void require_metric(const TomlKeys& keys, const std::string& metric, const Names& metrics)
{
    if (metric == "step_ms") keys.refuse("metric", "wall time is tracked, never judged");
    require_known(keys, "metric", metric, metrics, "unknown metric");
}

CheckScene read_scene(const toml::table& table, const std::string& file, const Names& before)
{
    TomlKeys keys(table, file, "scene of a check");
    CheckScene scene;
    scene.line = keys.line();
    keys.required("scene", scene.scene);
    scene.name = scene.scene;
    keys.optional("name", scene.name);
    keys.optional("set", scene.set);
    keys.optional("needs", scene.needs);
    keys.require_nothing_unknown();
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
    if (scene.name.empty() || !std::all_of(scene.name.begin(), scene.name.end(), is_plain))
        keys.refuse(keys.has("name") ? "name" : "scene",
                    "expected a `name` of letters, digits, _ and -: it names the records' folder");
    if (std::count(before.begin(), before.end(), scene.name)) keys.refuse("name", "expected each name of a scene once");
    return scene;
}

CheckBound read_bound(const toml::table& table, const std::string& file, const Names& scenes, const Names& metrics)
{
    TomlKeys keys(table, file, "bound of a check");
    CheckBound bound;
    bound.line = keys.line();
    keys.required("name", bound.name);
    keys.required("scene", bound.scene);
    keys.required("deformer", bound.deformer);
    keys.required("metric", bound.metric);
    keys.optional("low", bound.low);
    keys.optional("high", bound.high);
    keys.optional("frames", bound.frames);
    keys.required("why", bound.why);
    keys.require_nothing_unknown();
    require_known(keys, "scene", bound.scene, scenes, "expected a scene of this file");
    require_metric(keys, bound.metric, metrics);
    if (!keys.has("low") && !keys.has("high")) keys.refuse("low", "expected low, high or both");
    for (const auto& [key, value] : {std::pair("low", bound.low), std::pair("high", bound.high)})
        if (keys.has(key) && !std::isfinite(value))
            keys.refuse(key, "expected a finite number: all or nothing would hold");
    if (bound.low > bound.high) keys.refuse("low", "expected low <= high");
    const std::vector<int>& frames = bound.frames;
    if (keys.has("frames") && (frames.size() != 2 || frames[0] < 0 || frames[0] > frames[1]))
        keys.refuse("frames", "expected [first, last], 0 <= first <= last");
    return bound;
}

CheckTolerance read_tolerance(const toml::table& table, const std::string& file, const Names& metrics)
{
    TomlKeys keys(table, file, "tolerance of a check");
    CheckTolerance tolerance;
    tolerance.line = keys.line();
    keys.required("metric", tolerance.metric);
    keys.optional("absolute", tolerance.absolute);
    keys.optional("relative", tolerance.relative);
    keys.required("why", tolerance.why);
    keys.require_nothing_unknown();
    require_metric(keys, tolerance.metric, metrics);
    for (const auto& [key, value] :
         {std::pair("absolute", tolerance.absolute), std::pair("relative", tolerance.relative)})
        if (!(value >= 0.0 && std::isfinite(value))) keys.refuse(key, "expected a number >= 0");
    return tolerance;
}

template <typename Entry>
void require_once(const std::vector<Entry>& entries, std::string Entry::*name, const char* key, const std::string& file)
{
    for (std::size_t i = 0; i < entries.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (entries[i].*name == entries[j].*name)
                throw pbs::InputError(file, entries[i].line, key, entries[i].*name, "expected once");
}

double compared(const FrameBound& bound, const FrameValues& values)
{
    return bound.is_absolute ? std::abs(bound.of(values)) : bound.of(values);
}

bool holds(const FrameBound& bound, double value)
{
    return bound.is_upper ? value <= *bound.value : value >= *bound.value;
}

bool is_worse(const FrameBound& bound, double value, double than)
{
    if (std::isnan(than)) return false;
    return std::isnan(value) || (bound.is_upper ? value > than : value < than);
}

// The worst frame of a bound, and the number of frames outside.
struct JudgedFrames {
    std::size_t worst = 0, outside = 0;
};

JudgedFrames judged_frames(const FrameBound& bound, const std::vector<MeasuredFrame>& frames)
{
    JudgedFrames result;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double value = compared(bound, frames[i].values);
        result.outside += !holds(bound, value);
        if (is_worse(bound, value, compared(bound, frames[result.worst].values))) result.worst = i;
    }
    return result;
}

CheckCase judged(const std::string& suite, const FrameBound& bound, const std::vector<MeasuredFrame>& frames)
{
    const auto [worst, outside] = judged_frames(bound, frames);
    const double value = compared(bound, frames[worst].values);
    CheckCase check{suite,
                    fmt::format("{} {:g}", bound.option, *bound.value),
                    outside > 0 ? CheckState::failed : CheckState::held,
                    "",
                    static_cast<int>(worst),
                    value,
                    "",
                    0};
    check.message = fmt::format("frame {}: {} = {:.6g}, expected at {} {:g}", frames[worst].name, bound.metric, value,
                                bound.is_upper ? "most" : "least", *bound.value);
    if (outside > 1) check.message += fmt::format(" ({} of {} frames outside)", outside, frames.size());
    return check;
}

std::string counted(std::size_t frames)
{
    return fmt::format("{} frame{}", frames, frames == 1 ? "" : "s");
}

// "14 of 18 frames beyond 0.5 %, worst -8.64 % in frame 17"
std::string judged_text(const FrameBound& bound, const std::vector<MeasuredFrame>& frames)
{
    const auto [worst, outside] = judged_frames(bound, frames);
    const std::string name = bound.is_absolute ? "" : bound.metric + ": ";
    const std::string count =
        outside > 0 ? fmt::format("{} of {} {}", outside, counted(frames.size()), bound.is_upper ? "beyond" : "below")
                    : fmt::format("{} within", counted(frames.size()));
    return fmt::format("{}{} {:g}{}, worst {:.3g}{} in frame {}", name, count, *bound.value, bound.unit,
                       bound.of(frames[worst].values), bound.unit, frames[worst].name);
}

std::string volume_range(const std::vector<MeasuredFrame>& frames)
{
    const auto change_pct = [](const MeasuredFrame& frame) { return frame.values.metrics.volume_change_pct; };
    const auto [low, high] = std::ranges::minmax_element(frames, {}, change_pct);
    if (low == high) return fmt::format("measured: {}, volume {:.3g} %", counted(frames.size()), change_pct(*low));
    return fmt::format("measured: {}, volume {:.3g} % in frame {} to {:.3g} % in frame {}", counted(frames.size()),
                       change_pct(*low), low->name, change_pct(*high), high->name);
}

}  // namespace

CheckRules parse_check_rules(const std::string& text, const std::string& file, const std::vector<std::string>& metrics)
{
    const toml::table document = parse_toml_document(text, file, {"check", "claim", "quantity"});
    const toml::table* check = document["check"].as_table();
    if (!check) throw pbs::InputError(file, 0, "check", "", "expected [[check.scene]] and [[check.bound]] tables");
    TomlKeys keys(*check, file, "check");
    for (const char* known : {"scene", "bound", "tolerance"}) keys.mark_read(known);
    keys.require_nothing_unknown();

    CheckRules rules{file, {}, {}, {}};
    Names scenes;
    for (const toml::table* table : toml_tables(*check, "scene", file)) {
        rules.scenes.push_back(read_scene(*table, file, scenes));
        scenes.push_back(rules.scenes.back().name);
    }
    if (scenes.empty()) throw pbs::InputError(file, 0, "check.scene", "", "expected at least one [[check.scene]]");
    for (const toml::table* table : toml_tables(*check, "bound", file))
        rules.bounds.push_back(read_bound(*table, file, scenes, metrics));
    for (const toml::table* table : toml_tables(*check, "tolerance", file))
        rules.tolerances.push_back(read_tolerance(*table, file, metrics));
    require_once(rules.bounds, &CheckBound::name, "name", file);
    require_once(rules.tolerances, &CheckTolerance::metric, "metric", file);
    return rules;
}

std::vector<FrameBound> known_frame_bounds()
{
    using Values = const FrameValues&;
    constexpr double any = std::numeric_limits<double>::lowest();
    return {{"--max-volume-change", "|volume_change_pct|", "bound on |volume_change_pct| [%]", true, 0.0,
             [](Values f) { return f.metrics.volume_change_pct; }, " %", true},
            {"--max-volume-abs-change", "volume_abs_change_pct", "bound on volume_abs_change_pct [%]", true, 0.0,
             [](Values f) { return f.metrics.volume_abs_change_pct; }, " %"},
            {"--max-inverted", "inverted_tets", "bound on inverted_tets", true, 0.0,
             [](Values f) { return static_cast<double>(f.metrics.inverted_tets); }, "", false, Measured::tets},
            {"--min-j", "j_min", "bound on the smallest V / V0 of a tet", false, any,
             [](Values f) { return f.metrics.j_min; }, "", false, Measured::tets},
            {"--max-j", "j_max", "bound on the largest V / V0 of a tet", true, any, [](Values f) { return f.j_max; },
             "", false, Measured::tets},
            {"--max-edge-strain", "edge_strain_max", "bound on the largest |l / l0 - 1| of an edge", true, 0.0,
             [](Values f) { return f.edge_strain_max; }},
            {"--max-stretch-rms", "stretch_rms", "bound on the root mean square of l / l0 - 1 over the edges", true,
             0.0, [](Values f) { return f.metrics.stretch_rms; }, "", false, Measured::tets},
            {"--max-self-intersections", "self_intersections", "bound on the pairs of triangles of a surface that meet",
             true, 0.0, [](Values f) { return f.self_intersections; }, "", false, Measured::surface}};
}

void require_meaningful(const FrameBound& bound, Measured measured)
{
    if (!bound.value) return;
    if (bound.applies_to != Measured::both && bound.applies_to != measured)
        throw pbs::InputError("", 0, bound.option, number_text(*bound.value),
                              measured == Measured::surface
                                  ? "a surface has no tets: leave this bound out, or measure a tet mesh"
                                  : "is of surfaces: leave this bound out for a tet mesh");
    if (std::isfinite(*bound.value) && *bound.value >= bound.lowest) return;
    throw pbs::InputError("", 0, bound.option, number_text(*bound.value),
                          bound.lowest == 0.0 ? "expected a finite number >= 0" : "expected a finite number");
}

std::string broken_text(const FrameBound& bound, const FrameValues& values)
{
    if (!bound.value || holds(bound, compared(bound, values))) return "";
    return fmt::format("{} = {:.6g} {} {:g}", bound.metric, compared(bound, values), bound.is_upper ? '>' : '<',
                       *bound.value);
}

std::string frame_summary(const std::vector<FrameBound>& bounds, const std::vector<MeasuredFrame>& frames,
                          std::size_t refused)
{
    std::vector<std::string> failed, held;
    for (const FrameBound& bound : bounds)
        if (bound.value && !frames.empty())
            (judged_frames(bound, frames).outside > 0 ? failed : held).push_back(judged_text(bound, frames));
    std::string text;
    if (!failed.empty())
        text = fmt::format("fails: {}", fmt::join(failed, "; "));
    else if (!held.empty())
        text = fmt::format("holds: {}", fmt::join(held, "; "));
    else if (!frames.empty())
        text = volume_range(frames);
    if (refused == 0) return text;
    const std::string missing =
        fmt::format("{} of {} could not be measured", refused, counted(refused + frames.size()));
    return failed.empty() ? fmt::format("refused: {}{}{}", missing, text.empty() ? "" : "; the others: ", text)
                          : fmt::format("{}; {}", text, missing);
}

CheckSuite frame_suite(const std::string& name, const std::vector<FrameBound>& bounds,
                       const std::vector<MeasuredFrame>& frames, const std::vector<RefusedFrame>& refused,
                       double seconds)
{
    CheckSuite suite{name, seconds, {}, {}};
    for (const FrameBound& bound : bounds)
        if (bound.value && !frames.empty()) suite.cases.push_back(judged(name, bound, frames));
    if (suite.cases.empty() && !frames.empty())
        suite.cases.push_back({name,
                               "measured",
                               CheckState::held,
                               fmt::format("{} frames, no bounds", frames.size()),
                               std::nullopt,
                               {},
                               "",
                               0});
    for (const RefusedFrame& frame : refused)
        suite.cases.push_back(
            {name, "frame " + frame.name, CheckState::refused, frame.reason, std::nullopt, {}, "", 0});
    return suite;
}

}  // namespace analysis
