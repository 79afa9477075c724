#include "analysis/check/check_judgement.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

std::string interval_text(const CheckBound& bound)
{
    if (std::isinf(bound.low)) return fmt::format("at most {:g}", bound.high);
    if (std::isinf(bound.high)) return fmt::format("at least {:g}", bound.low);
    if (bound.low == bound.high) return fmt::format("{:g}", bound.low);
    return fmt::format("{:g} to {:g}", bound.low, bound.high);
}

// How far the value lies outside; negative inside. NaN counts as farthest outside.
double excess(const CheckBound& bound, double value)
{
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(bound.low - value, value - bound.high);
}

[[noreturn]] void refuse(const CheckBound& bound, const std::string& file, const std::string& field, const std::string& value,
                         const std::string& rule)
{
    throw pbs::InputError(file, bound.line, field, value, rule);
}

struct FrameValue {
    int frame = -1;
    double value = 0.0;
};

struct Seen {
    int frames = 0, outside = 0, last_frame = -1, first_outside = -1;
    FrameValue worst, least, largest;
};

Seen look_at(const CheckBound& bound, const CsvTable& metrics, const std::string& file)
{
    Seen seen;
    bool has_deformer = false;
    for (int row = 0; row < metrics.rows(); ++row) {
        if (metrics.text_at(row, "deformer") != bound.deformer) continue;
        has_deformer = true;
        const int frame = static_cast<int>(metrics.integer(row, "frame"));
        seen.last_frame = std::max(seen.last_frame, frame);
        if (!bound.frames.empty() && (frame < bound.frames[0] || frame > bound.frames[1])) continue;
        const std::optional<double> value = metrics.number_or_nothing(row, bound.metric);
        if (!value) refuse(bound, file, "metric", bound.metric, fmt::format("{} has no such value in frame {}", bound.deformer, frame));
        const bool outside = excess(bound, *value) > 0.0;
        if (outside && seen.outside++ == 0) seen.first_outside = frame;
        const bool is_first = seen.frames++ == 0;
        if (is_first || excess(bound, *value) > excess(bound, seen.worst.value)) seen.worst = {frame, *value};
        if (is_first || *value < seen.least.value) seen.least = {frame, *value};
        if (is_first || *value > seen.largest.value) seen.largest = {frame, *value};
    }
    if (!has_deformer) refuse(bound, file, "deformer", bound.deformer, "expected one that the scene uses");
    if (!bound.frames.empty() && bound.frames[1] > seen.last_frame)
        refuse(bound, file, "frames", fmt::format("[{}, {}]", bound.frames[0], bound.frames[1]),
               fmt::format("expected at most {}, the last of the scene", seen.last_frame));
    return seen;
}

bool holds_between(const CheckBound& bound, const Seen& seen)
{
    return seen.outside == 0 && std::isfinite(bound.low) && std::isfinite(bound.high) && seen.least.value < seen.largest.value;
}

std::string values_text(const CheckBound& bound, const Seen& seen, const std::string& unit)
{
    if (holds_between(bound, seen))
        return fmt::format("frames {} and {}: {} of {} = {:.6g} to {:.6g}{}", seen.least.frame, seen.largest.frame, bound.metric,
                           bound.deformer, seen.least.value, seen.largest.value, unit);
    return fmt::format("frame {}: {} of {} = {:.6g}{}", seen.worst.frame, bound.metric, bound.deformer, seen.worst.value, unit);
}

}  // namespace

CheckCase judge_bound(const CheckBound& bound, const std::string& unit, const CsvTable& metrics, const std::string& rules_file)
{
    if (!metrics.has_column(bound.metric)) refuse(bound, rules_file, "metric", bound.metric, "the scene does not measure it");
    const Seen seen = look_at(bound, metrics, rules_file);
    const std::string of_unit = unit.empty() ? "" : " " + unit;
    CheckCase check{bound.scene, bound.name,       seen.outside > 0 ? CheckState::failed : CheckState::held,
                    "",          seen.worst.frame, seen.worst.value,
                    rules_file,  bound.line};
    check.message = fmt::format("{}, expected {}{}", values_text(bound, seen, of_unit), interval_text(bound), of_unit);
    if (seen.outside > 1)
        check.message += fmt::format(" ({} of {} frames outside, the first is {})", seen.outside, seen.frames, seen.first_outside);
    return check;
}

}  // namespace analysis
