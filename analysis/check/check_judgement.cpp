#include "analysis/check/check.hpp"

#include "analysis/statistics/statistics.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <tuple>

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
    return std::isnan(value) ? std::numeric_limits<double>::infinity()
                             : std::max(bound.low - value, value - bound.high);
}

[[noreturn]] void refuse(const CheckBound& bound, const std::string& file, const std::string& field,
                         const std::string& value, const std::string& rule)
{
    throw pbs::InputError(file, bound.line, field, value, rule);
}

struct FrameValue {
    int frame = -1;
    double value = 0.0;
};

struct Seen {
    int frames = 0, outside = 0, first_outside = -1;
    FrameValue worst, least, largest;
};

Seen look_at(const CheckBound& bound, const CsvTable& metrics, const std::string& file)
{
    const CsvTable own = metrics.where("deformer", bound.deformer);
    if (own.rows() == 0) refuse(bound, file, "deformer", bound.deformer, "expected one that the scene uses");
    std::vector<FrameValue> values;
    int last_frame = -1;
    for (const CsvTable::Row& row : own) {
        const int frame = row.value<int>("frame");
        last_frame = std::max(last_frame, frame);
        if (!bound.frames.empty() && (frame < bound.frames[0] || frame > bound.frames[1])) continue;
        const std::optional<double> value = row.number_or_nothing(bound.metric);
        if (!value)
            refuse(bound, file, "metric", bound.metric,
                   fmt::format("{} has no such value in frame {}", bound.deformer, frame));
        values.push_back({frame, *value});
    }
    if (!bound.frames.empty() && bound.frames[1] > last_frame)
        refuse(bound, file, "frames", fmt::format("[{}, {}]", bound.frames[0], bound.frames[1]),
               fmt::format("expected at most {}, the last of the scene", last_frame));
    if (values.empty()) return {};
    const auto excess_of = [&](const FrameValue& value) { return excess(bound, value.value); };
    const auto is_outside = [&](const FrameValue& value) { return excess_of(value) > 0.0; };
    const auto first_outside = std::ranges::find_if(values, is_outside);
    return {.frames = static_cast<int>(values.size()),
            .outside = static_cast<int>(std::ranges::count_if(values, is_outside)),
            .first_outside = first_outside == values.end() ? -1 : first_outside->frame,
            .worst = *std::ranges::max_element(values, {}, excess_of),
            .least = *std::ranges::min_element(values, {}, &FrameValue::value),
            .largest = *std::ranges::max_element(values, {}, &FrameValue::value)};
}

bool holds_between(const CheckBound& bound, const Seen& seen)
{
    return seen.outside == 0 && std::isfinite(bound.low) && std::isfinite(bound.high) &&
           seen.least.value < seen.largest.value;
}

std::string values_text(const CheckBound& bound, const Seen& seen, const std::string& unit)
{
    if (holds_between(bound, seen))
        return fmt::format("frames {} and {}: {} of {} = {:.6g} to {:.6g}{}", seen.least.frame, seen.largest.frame,
                           bound.metric, bound.deformer, seen.least.value, seen.largest.value, unit);
    return fmt::format("frame {}: {} of {} = {:.6g}{}", seen.worst.frame, bound.metric, bound.deformer,
                       seen.worst.value, unit);
}

const std::vector<std::string> count_columns = {"vertices", "tets", "iterations"};

std::vector<std::string> columns_of(const CheckRules& rules)
{
    std::vector<std::string> columns = {"scene", "deformer", "frame"};
    columns.insert(columns.end(), count_columns.begin(), count_columns.end());
    for (const CheckTolerance& tolerance : rules.tolerances) columns.push_back(tolerance.metric);
    columns.push_back("step_ms");
    return columns;
}

// The frames of each deformer in a scene.
std::map<std::string, CsvTable> frames_of(const CsvTable& table, const std::string& scene)
{
    std::map<std::string, CsvTable> frames;
    for (const CsvTable& of_deformer : table.where("scene", scene).groups({"deformer"}))
        frames.emplace(of_deformer[0].text("deformer"), of_deformer);
    return frames;
}

CsvTable frames_of(const CsvTable& table, const std::string& scene, const std::string& deformer)
{
    return table.where({{"scene", scene}, {"deformer", deformer}});
}

void require_columns(const CheckRules& rules, const CsvTable& baseline, const std::string& file)
{
    for (const std::string& column : columns_of(rules))
        if (!baseline.has_column(column))
            throw pbs::InputError(file, 1, "column", column,
                                  "missing: expected a file of `pbskin check --write-baseline`");
}

// The difference in a frame, and how many times its tolerance that is; none if nothing has changed.
struct Difference {
    double times = 0.0;
    std::string text;
};

Difference difference_of(const CheckTolerance& tolerance, std::optional<double> now, std::optional<double> then)
{
    const auto text = [](std::optional<double> value) { return value ? number_text(*value) : "nothing"; };
    const std::string message = fmt::format("{} was {}, is {}", tolerance.metric, text(then), text(now));
    if (now.has_value() != then.has_value()) return {std::numeric_limits<double>::infinity(), message};
    if (!now || *now == *then || (std::isnan(*now) && std::isnan(*then))) return {};
    const double allowed = tolerance.absolute + tolerance.relative * std::abs(*then), moved = std::abs(*now - *then);
    if (moved <= allowed) return {};
    return {allowed > 0.0 && std::isfinite(moved) ? moved / allowed : std::numeric_limits<double>::infinity(),
            fmt::format("{}, tolerance {:g}", message, allowed)};
}

std::vector<CheckTolerance> all_tolerances(const CheckRules& rules)
{
    std::vector<CheckTolerance> tolerances;
    for (const std::string& column : count_columns) tolerances.push_back({column, 0.0, 0.0, "a count", 0});
    tolerances.insert(tolerances.end(), rules.tolerances.begin(), rules.tolerances.end());
    return tolerances;
}

CheckCase compare_deformer(const CheckRules& rules, const std::string& scene, const std::string& deformer,
                           const CsvTable& now, const CsvTable& baseline)
{
    CheckCase check{scene, "baseline of " + deformer, CheckState::held, "", std::nullopt, std::nullopt, "", 0};
    const std::map<std::string, CsvTable::Row> baseline_frames = baseline.by("frame");
    Difference worst;
    int differing = 0, shared = 0;
    for (const CsvTable::Row& row : now) {
        const auto before = baseline_frames.find(row.text("frame"));
        if (before == baseline_frames.end()) continue;
        ++shared;
        Difference of_frame;
        for (const CheckTolerance& tolerance : all_tolerances(rules)) {
            const Difference difference = difference_of(tolerance, row.number_or_nothing(tolerance.metric),
                                                        before->second.number_or_nothing(tolerance.metric));
            if (difference.times > of_frame.times) of_frame = difference;
        }
        differing += of_frame.times > 0.0;
        if (of_frame.times > worst.times) {
            worst = of_frame;
            check.frame = row.value<int>("frame");
        }
    }
    check.state = CheckState::failed;
    if (differing > 0) {
        check.message =
            fmt::format("frame {}: {} ({} of {} frames differ)", *check.frame, worst.text, differing, now.rows());
    } else if (shared < now.rows() || shared < baseline.rows()) {
        check.message = fmt::format("{} frames, the baseline has {}", now.rows(), baseline.rows());
    } else {
        check.state = CheckState::held;
        check.message = fmt::format("{} frames as before", now.rows());
    }
    return check;
}

}  // namespace

CheckCase judge_bound(const CheckBound& bound, const std::string& unit, const CsvTable& metrics,
                      const std::string& rules_file)
{
    if (!metrics.has_column(bound.metric))
        refuse(bound, rules_file, "metric", bound.metric, "the scene does not measure it");
    const Seen seen = look_at(bound, metrics, rules_file);
    const std::string of_unit = unit.empty() ? "" : " " + unit;
    CheckCase check{bound.scene, bound.name,       seen.outside > 0 ? CheckState::failed : CheckState::held,
                    "",          seen.worst.frame, seen.worst.value,
                    rules_file,  bound.line};
    check.message = fmt::format("{}, expected {}{}", values_text(bound, seen, of_unit), interval_text(bound), of_unit);
    if (seen.outside > 1)
        check.message +=
            fmt::format(" ({} of {} frames outside, the first is {})", seen.outside, seen.frames, seen.first_outside);
    return check;
}

CsvTable baseline_columns(const CheckRules& rules)
{
    return CsvTable(columns_of(rules));
}

void add_baseline_rows(CsvTable& baseline, const std::string& scene, const CsvTable& metrics, int vertices, int tets)
{
    for (const CsvTable::Row& row : metrics) {
        CsvTable::NamedCells cells;
        for (const std::string& column : baseline.columns())
            if (metrics.has_column(column)) cells.emplace_back(column, row.text(column));
        cells.insert(cells.end(), {{"scene", scene}, {"vertices", vertices}, {"tets", tets}});
        baseline.add(cells);
    }
}

void require_baseline(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file)
{
    require_columns(rules, baseline, baseline_file);
    for (const CsvTable& frames : baseline.groups({"scene", "deformer"})) {
        for (const CsvTable::Row& row : frames) row.integer("frame");
        frames.by("frame");  // each once
    }
}

std::vector<CheckCase> scenes_gone(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file)
{
    std::vector<CheckCase> cases;
    std::set<std::string> known;
    for (const CheckScene& scene : rules.scenes) known.insert(scene.name);
    for (const CsvTable& frames : baseline.groups({"scene"}))
        if (const std::string& scene = frames[0].text("scene"); !known.contains(scene))
            cases.push_back({scene, "baseline", CheckState::failed, "in the baseline, but no longer among the scenes",
                             std::nullopt, std::nullopt, baseline_file, frames[0].line()});
    return cases;
}

std::vector<CheckCase> compare_with_baseline(const CheckRules& rules, const std::string& scene, const CsvTable& now,
                                             const CsvTable& baseline, const std::string& baseline_file)
{
    std::vector<CheckCase> cases;
    for (const auto& [deformer, frames] : frames_of(now, scene)) {
        cases.push_back(compare_deformer(rules, scene, deformer, frames, frames_of(baseline, scene, deformer)));
        cases.back().file = baseline_file;
    }
    for (const auto& [deformer, frames] : frames_of(baseline, scene))
        if (frames_of(now, scene, deformer).rows() == 0)
            cases.push_back({scene, "baseline of " + deformer, CheckState::failed,
                             "in the baseline, but no longer in the scene", std::nullopt, std::nullopt, baseline_file,
                             0});
    return cases;
}

std::vector<std::pair<std::string, std::string>> step_times(const std::string& scene, const CsvTable& now,
                                                            const CsvTable* baseline)
{
    std::vector<std::pair<std::string, std::string>> times;
    for (const auto& [deformer, frames] : frames_of(now, scene)) {
        const double ms = median(frames.numbers("step_ms"));
        const std::vector<double> before_ms =
            baseline ? frames_of(*baseline, scene, deformer).numbers("step_ms") : std::vector<double>{};
        times.emplace_back(
            "wall time of " + deformer,
            fmt::format("{:.4g} ms per step", ms) +
                (before_ms.empty() ? "" : fmt::format(", {:.3g} of the baseline's", ms / median(before_ms))));
    }
    return times;
}

}  // namespace analysis
