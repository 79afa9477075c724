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
        if (!value)
            refuse(bound, file, "metric", bound.metric,
                   fmt::format("{} has no such value in frame {}", bound.deformer, frame));
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

using Rows = std::map<std::string, std::map<int, int>>;  // deformer -> frame -> row

Rows rows_of(const CsvTable& table, const std::string& scene)
{
    Rows rows;
    for (int row = 0; row < table.rows(); ++row)
        if (table.text_at(row, "scene") == scene)
            rows[table.text_at(row, "deformer")][static_cast<int>(table.integer(row, "frame"))] = row;
    return rows;
}

// The line of a row, below the header. No field of a baseline contains a line break.
int line_of(int row)
{
    return row + 2;
}

void require_columns(const CheckRules& rules, const CsvTable& baseline, const std::string& file)
{
    for (const std::string& column : columns_of(rules))
        if (!baseline.has_column(column))
            throw pbs::InputError(file, 1, "column", column,
                                  "missing: expected a file of `pbskin check --write-baseline`");
}

void require_each_frame_once(const CsvTable& baseline, const std::string& file)
{
    std::map<std::tuple<std::string, std::string, long long>, int> lines;
    for (int row = 0; row < baseline.rows(); ++row) {
        const long long frame = baseline.integer(row, "frame");
        const auto [at, is_new] = lines.emplace(
            std::tuple(baseline.text_at(row, "scene"), baseline.text_at(row, "deformer"), frame), line_of(row));
        if (!is_new)
            throw pbs::InputError(
                file, line_of(row), "frame", std::to_string(frame),
                fmt::format("expected each frame of a scene's deformer once: it is in line {} too", at->second));
    }
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
                           const CsvTable& now, const std::map<int, int>& now_rows, const CsvTable& baseline,
                           const std::map<int, int>& baseline_rows)
{
    CheckCase check{scene, "baseline of " + deformer, CheckState::held, "", std::nullopt, std::nullopt, "", 0};
    Difference worst;
    int differing = 0;
    for (const auto& [frame, row] : now_rows) {
        const auto before = baseline_rows.find(frame);
        if (before == baseline_rows.end()) continue;
        Difference of_frame;
        for (const CheckTolerance& tolerance : all_tolerances(rules)) {
            const Difference difference = difference_of(tolerance, now.number_or_nothing(row, tolerance.metric),
                                                        baseline.number_or_nothing(before->second, tolerance.metric));
            if (difference.times > of_frame.times) of_frame = difference;
        }
        differing += of_frame.times > 0.0;
        if (of_frame.times > worst.times) {
            worst = of_frame;
            check.frame = frame;
        }
    }
    const auto same_frame = [](const auto& a, const auto& b) { return a.first == b.first; };
    if (differing > 0) {
        check.state = CheckState::failed;
        check.message =
            fmt::format("frame {}: {} ({} of {} frames differ)", *check.frame, worst.text, differing, now_rows.size());
    } else if (!std::equal(now_rows.begin(), now_rows.end(), baseline_rows.begin(), baseline_rows.end(), same_frame)) {
        check.state = CheckState::failed;
        check.message = fmt::format("{} frames, the baseline has {}", now_rows.size(), baseline_rows.size());
    } else {
        check.message = fmt::format("{} frames as before", now_rows.size());
    }
    return check;
}

double median_step_ms(const CsvTable& table, const std::map<int, int>& rows)
{
    std::vector<double> steps;
    for (const auto& [frame, row] : rows) steps.push_back(table.number(row, "step_ms"));
    return median(steps);
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
    for (int row = 0; row < metrics.rows(); ++row) {
        const auto cell = [&](const std::string& column) -> CsvTable::Cell {
            if (column == "scene") return scene;
            if (column == "vertices") return vertices;
            if (column == "tets") return tets;
            return metrics.has_column(column) ? CsvTable::Cell(metrics.text_at(row, column))
                                              : CsvTable::Cell(std::nullopt);
        };
        std::vector<CsvTable::Cell> cells;
        for (const std::string& column : baseline.columns()) cells.push_back(cell(column));
        baseline.add_row(cells);
    }
}

void require_baseline(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file)
{
    require_columns(rules, baseline, baseline_file);
    require_each_frame_once(baseline, baseline_file);
}

std::vector<CheckCase> scenes_gone(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file)
{
    std::vector<CheckCase> cases;
    std::set<std::string> known;
    for (const CheckScene& scene : rules.scenes) known.insert(scene.name);
    for (int row = 0; row < baseline.rows(); ++row)
        if (const std::string& scene = baseline.text_at(row, "scene"); known.insert(scene).second)
            cases.push_back({scene, "baseline", CheckState::failed, "in the baseline, but no longer among the scenes",
                             std::nullopt, std::nullopt, baseline_file, line_of(row)});
    return cases;
}

std::vector<CheckCase> compare_with_baseline(const CheckRules& rules, const std::string& scene, const CsvTable& now,
                                             const CsvTable& baseline, const std::string& baseline_file)
{
    const Rows now_rows = rows_of(now, scene), baseline_rows = rows_of(baseline, scene);
    std::vector<CheckCase> cases;
    for (const auto& [deformer, rows] : now_rows) {
        const auto before = baseline_rows.find(deformer);
        const std::map<int, int> none;
        cases.push_back(compare_deformer(rules, scene, deformer, now, rows, baseline,
                                         before == baseline_rows.end() ? none : before->second));
        cases.back().file = baseline_file;
    }
    for (const auto& [deformer, rows] : baseline_rows)
        if (!now_rows.contains(deformer))
            cases.push_back({scene, "baseline of " + deformer, CheckState::failed,
                             "in the baseline, but no longer in the scene", std::nullopt, std::nullopt, baseline_file,
                             0});
    return cases;
}

std::vector<std::pair<std::string, std::string>> step_times(const std::string& scene, const CsvTable& now,
                                                            const CsvTable* baseline)
{
    std::vector<std::pair<std::string, std::string>> times;
    const Rows before = baseline ? rows_of(*baseline, scene) : Rows();
    for (const auto& [deformer, rows] : rows_of(now, scene)) {
        const double ms = median_step_ms(now, rows);
        const auto found = before.find(deformer);
        times.emplace_back("wall time of " + deformer,
                           fmt::format("{:.4g} ms per step", ms) +
                               (found == before.end() ? ""
                                                      : fmt::format(", {:.3g} of the baseline's",
                                                                    ms / median_step_ms(*baseline, found->second))));
    }
    return times;
}

}  // namespace analysis
