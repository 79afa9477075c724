#include "analysis/check/frame_bounds.hpp"

#include "analysis/records/csv_table.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace analysis {
namespace {

bool holds(const FrameBound& bound, double value)
{
    return bound.is_upper ? value <= *bound.value : value >= *bound.value;
}

bool is_worse(const FrameBound& bound, double value, double than)
{
    if (std::isnan(than)) return false;
    return std::isnan(value) || (bound.is_upper ? value > than : value < than);
}

CheckCase judged(const std::string& suite, const FrameBound& bound, const std::vector<MeasuredFrame>& frames)
{
    std::size_t worst = 0, outside = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double value = bound.of(frames[i].values);
        outside += !holds(bound, value);
        if (is_worse(bound, value, bound.of(frames[worst].values))) worst = i;
    }
    const double value = bound.of(frames[worst].values);
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

}  // namespace

std::vector<FrameBound> known_frame_bounds()
{
    using Values = const FrameValues&;
    constexpr double any = std::numeric_limits<double>::lowest();
    return {{"--max-volume-change", "|volume_change_pct|", "bound on |volume_change_pct| [%]", true, 0.0,
             [](Values f) { return std::abs(f.metrics.volume_change_pct); }},
            {"--max-volume-abs-change", "volume_abs_change_pct", "bound on volume_abs_change_pct [%]", true, 0.0,
             [](Values f) { return f.metrics.volume_abs_change_pct; }},
            {"--max-inverted", "inverted_tets", "bound on inverted_tets", true, 0.0,
             [](Values f) { return static_cast<double>(f.metrics.inverted_tets); }},
            {"--min-j", "j_min", "bound on the smallest V / V0 of a tet", false, any, [](Values f) { return f.metrics.j_min; }},
            {"--max-j", "j_max", "bound on the largest V / V0 of a tet", true, any, [](Values f) { return f.j_max; }},
            {"--max-edge-strain", "edge_strain_max", "bound on the largest |l / l0 - 1| of an edge", true, 0.0,
             [](Values f) { return f.edge_strain_max; }},
            {"--max-stretch-rms", "stretch_rms", "bound on the root mean square of l / l0 - 1 over the edges", true, 0.0,
             [](Values f) { return f.metrics.stretch_rms; }}};
}

void require_meaningful(const FrameBound& bound)
{
    if (!bound.value || (std::isfinite(*bound.value) && *bound.value >= bound.lowest)) return;
    throw pbs::InputError("", 0, bound.option, number_text(*bound.value),
                          bound.lowest == 0.0 ? "expected a finite number >= 0" : "expected a finite number");
}

std::string broken_text(const FrameBound& bound, const FrameValues& values)
{
    if (!bound.value || holds(bound, bound.of(values))) return "";
    return fmt::format("{} = {:.6g} {} {:g}", bound.metric, bound.of(values), bound.is_upper ? '>' : '<', *bound.value);
}

CheckSuite frame_suite(const std::string& name, const std::vector<FrameBound>& bounds, const std::vector<MeasuredFrame>& frames,
                       const std::vector<RefusedFrame>& refused, double seconds)
{
    CheckSuite suite{name, seconds, {}, {}};
    for (const FrameBound& bound : bounds)
        if (bound.value && !frames.empty()) suite.cases.push_back(judged(name, bound, frames));
    if (suite.cases.empty() && !frames.empty())
        suite.cases.push_back(
            {name, "measured", CheckState::held, fmt::format("{} frames, no bounds", frames.size()), std::nullopt, {}, "", 0});
    for (const RefusedFrame& frame : refused)
        suite.cases.push_back({name, "frame " + frame.name, CheckState::refused, frame.reason, std::nullopt, {}, "", 0});
    return suite;
}

}  // namespace analysis
