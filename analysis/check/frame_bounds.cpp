// Bounds on single frames: the options of `pbskin measure` (known_frame_bounds), and the results of frames by these
// bounds as test cases (frame_suite) and in one line (frame_summary). check.hpp declares them.

#include "analysis/check/check.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace analysis {
namespace {

// The number that is compared with the bound.
double compared_value(const FrameBound& bound, const FrameValues& values)
{
    return bound.is_absolute ? std::abs(bound.of(values)) : bound.of(values);
}

bool holds(const FrameBound& bound, double value)
{
    return bound.is_upper ? value <= *bound.value : value >= *bound.value;
}

// Is `value` farther on the wrong side of the bound than `other`? A value that is not a number is the worst.
bool is_worse(const FrameBound& bound, double value, double other)
{
    if (std::isnan(other)) return false;
    return std::isnan(value) || (bound.is_upper ? value > other : value < other);
}

struct JudgedFrames {
    std::size_t worst = 0;    // the worst frame of the bound
    std::size_t outside = 0;  // the number of frames in which the bound does not hold
};

JudgedFrames judge_frames(const FrameBound& bound, const std::vector<MeasuredFrame>& frames)
{
    JudgedFrames result;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double value = compared_value(bound, frames[i].values);
        result.outside += !holds(bound, value);
        if (is_worse(bound, value, compared_value(bound, frames[result.worst].values))) result.worst = i;
    }
    return result;
}

// The case of a bound in a suite.
CheckCase bound_case(const std::string& suite, const FrameBound& bound, const std::vector<MeasuredFrame>& frames)
{
    const auto [worst, outside] = judge_frames(bound, frames);
    const double value = compared_value(bound, frames[worst].values);
    CheckCase check{.suite = suite,
                    .name = fmt::format("{} {:g}", bound.option, *bound.value),
                    .state = outside > 0 ? CheckState::failed : CheckState::held,
                    .frame = static_cast<int>(worst),
                    .value = value};
    check.message = fmt::format("frame {}: {} = {:.6g}, expected at {} {:g}", frames[worst].name, bound.metric, value,
                                bound.is_upper ? "most" : "least", *bound.value);
    if (outside > 1) check.message += fmt::format(" ({} of {} frames outside)", outside, frames.size());
    return check;
}

// "1 frame", "18 frames"
std::string frames_text(std::size_t frames)
{
    return fmt::format("{} frame{}", frames, frames == 1 ? "" : "s");
}

// "14 of 18 frames beyond 0.5 %, worst -8.64 % in frame 17"
std::string bound_text(const FrameBound& bound, const std::vector<MeasuredFrame>& frames)
{
    const auto [worst, outside] = judge_frames(bound, frames);
    const std::string name = bound.is_absolute ? "" : bound.metric + ": ";
    const std::string count = outside > 0 ? fmt::format("{} of {} {}", outside, frames_text(frames.size()),
                                                        bound.is_upper ? "beyond" : "below")
                                          : fmt::format("{} within", frames_text(frames.size()));
    return fmt::format("{}{} {:g}{}, worst {:.3g}{} in frame {}", name, count, *bound.value, bound.unit,
                       bound.of(frames[worst].values), bound.unit, frames[worst].name);
}

// "measured: 18 frames, volume -8.64 % in frame 17 to 0.1 % in frame 3"
std::string volume_range_text(const std::vector<MeasuredFrame>& frames)
{
    const auto change_pct = [](const MeasuredFrame& frame) { return frame.values.metrics.volume_change_pct; };
    const auto [low, high] = std::ranges::minmax_element(frames, {}, change_pct);
    if (low == high) return fmt::format("measured: {}, volume {:.3g} %", frames_text(frames.size()), change_pct(*low));
    return fmt::format("measured: {}, volume {:.3g} % in frame {} to {:.3g} % in frame {}", frames_text(frames.size()),
                       change_pct(*low), low->name, change_pct(*high), high->name);
}

}  // namespace

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
    if (!bound.value) return "";
    const double value = compared_value(bound, values);
    if (holds(bound, value)) return "";
    return fmt::format("{} = {:.6g} {} {:g}", bound.metric, value, bound.is_upper ? '>' : '<', *bound.value);
}

std::string frame_summary(const std::vector<FrameBound>& bounds, const std::vector<MeasuredFrame>& frames,
                          std::size_t refused)
{
    std::vector<std::string> failed, held;
    for (const FrameBound& bound : bounds)
        if (bound.value && !frames.empty())
            (judge_frames(bound, frames).outside > 0 ? failed : held).push_back(bound_text(bound, frames));
    std::string text;
    if (!failed.empty())
        text = fmt::format("fails: {}", fmt::join(failed, "; "));
    else if (!held.empty())
        text = fmt::format("holds: {}", fmt::join(held, "; "));
    else if (!frames.empty())
        text = volume_range_text(frames);
    if (refused == 0) return text;
    const std::string missing =
        fmt::format("{} of {} could not be measured", refused, frames_text(refused + frames.size()));
    return failed.empty() ? fmt::format("refused: {}{}{}", missing, text.empty() ? "" : "; the others: ", text)
                          : fmt::format("{}; {}", text, missing);
}

CheckSuite frame_suite(const std::string& name, const std::vector<FrameBound>& bounds,
                       const std::vector<MeasuredFrame>& frames, const std::vector<RefusedFrame>& refused,
                       double seconds)
{
    CheckSuite suite{name, seconds, {}, {}};
    for (const FrameBound& bound : bounds)
        if (bound.value && !frames.empty()) suite.cases.push_back(bound_case(name, bound, frames));
    if (suite.cases.empty() && !frames.empty())
        suite.cases.push_back(
            {.suite = name, .name = "measured", .message = fmt::format("{} frames, no bounds", frames.size())});
    for (const RefusedFrame& frame : refused)
        suite.cases.push_back(
            {.suite = name, .name = "frame " + frame.name, .state = CheckState::refused, .message = frame.reason});
    return suite;
}

}  // namespace analysis
