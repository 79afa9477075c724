// C11: what the stiffness k in [0, 1] amounts to, as force over displacement of flesh that hangs under gravity, against
// iterations, time step and resolution. PBS, PBS with Mueller's exponent and XPBD run. XPBD has the stiffness of a
// material, and is the control. On the limb XPBD also runs with its multipliers reset in every iteration: a control
// that has to fail, and no part of the claim. README.md describes the runs and records.
#include "analysis/records/tables.hpp"
#include "analysis/statistics/fits.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"
#include "experiments/studies/study.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

namespace experiments {

namespace {

struct VariedText {
    const char* quantity;  // in measurements.csv
    double first, last;    // settings next to the paper's: iterations, 1 / time step [1/s], vertices
};

const VariedText& text_of(Varied varied)
{
    static constexpr VariedText texts[] = {{"stiffness_ratio_at_twice_iterations", 12.0, 48.0},
                                           {"stiffness_ratio_at_half_time_step", 1.0 / 0.02, 1.0 / 0.005},
                                           {"stiffness_ratio_at_twice_resolution", 0.0, 1e9}};
    return texts[static_cast<int>(varied)];
}

struct Point {
    double x = 0.0, stiffness = 0.0;
};

struct Case {
    // by order and "tenth finer"; the first is file order on the wanted meshes
    std::map<std::pair<int, bool>, std::vector<Point>> series;
    int left_out = 0;
};

double x_of(const StiffnessRow& row, Varied varied)
{
    if (varied == Varied::resolution) return row.vertices;
    return varied == Varied::iterations ? row.setting.iterations : 1.0 / row.setting.time_step_s();
}

const char* deformer_of(Method method)
{
    static constexpr const char* names[] = {"pbs", "pbs_exponent", "xpbd", "xpbd_small_steps",
                                            "xpbd_forgetting_multipliers"};
    return names[static_cast<int>(method)];
}

// Everything that is not varied, except for a repetition in another order or on the second series of meshes.
analysis::CaseKey key_of(const StiffnessRow& row, Varied varied)
{
    const StiffnessSetting& setting = row.setting;
    analysis::CaseKey key = {.body = row.body, .deformer = deformer_of(setting.method), .load = row.load};
    if (is_xpbd(setting.method))
        key.young_pa = setting.young_pa;
    else
        key.k_stretch = setting.k_stretch;
    if (varied != Varied::iterations) key.iterations = setting.iterations;
    if (varied != Varied::time_step) key.time_step_s = setting.time_step_s();
    if (varied != Varied::resolution) key.vertices = row.vertices;
    if (row.by == "stepped") key.ladder = row.by;
    return key;
}

std::map<analysis::CaseKey, Case> cases_of(const std::vector<StiffnessRow>& rows, Varied varied)
{
    std::map<analysis::CaseKey, Case> cases;
    for (const StiffnessRow& row : rows) {
        Case& own = cases[key_of(row, varied)];
        const bool usable = row.converged && std::isfinite(row.stiffness_n_m) && row.stiffness_n_m > 0.0;
        own.left_out += !usable;
        if (usable)
            own.series[{row.setting.order_seed, row.mesh != "wanted"}].push_back(
                {x_of(row, varied), row.stiffness_n_m});
    }
    for (auto& [key, own] : cases)
        for (auto& [order_and_mesh, points] : own.series) std::ranges::sort(points, {}, &Point::x);
    return cases;
}

double for_one_doubling(const Point& once, const Point& more)
{
    return std::pow(more.stiffness / once.stiffness, std::log(2.0) / std::log(more.x / once.x));
}

// The settings between which the ratio is taken.
analysis::CaseKey over_range(analysis::CaseKey key, Varied varied, double first, double last)
{
    if (varied == Varied::iterations) {
        key.iterations = first;
        key.iterations_to = last;
    } else if (varied == Varied::time_step) {
        key.time_step_s = 1.0 / first;
        key.time_step_to_s = 1.0 / last;
    } else {
        key.vertices = first;
        key.vertices_to = last;
    }
    return key;
}

std::optional<analysis::Measurement> ratio_of(const analysis::CaseKey& key, const Case& measured, Varied varied)
{
    constexpr double rounding = 1e-9;
    const VariedText& text = text_of(varied);
    std::optional<analysis::Measurement> result;
    for (const auto& [order_and_mesh, series] : measured.series) {
        std::vector<Point> points;
        std::ranges::copy_if(series, std::back_inserter(points), [&](const Point& point) {
            return point.x >= text.first * (1.0 - rounding) && point.x <= text.last * (1.0 + rounding);
        });
        if (points.size() < 2) continue;
        const double overall = for_one_doubling(points.front(), points.back());
        if (!result)
            result = {"C11",   text.quantity, over_range(key, varied, points.front().x, points.back().x),
                      overall, overall,       overall,
                      "1"};
        for (std::size_t i = 1; i < points.size(); ++i) {
            const double single = for_one_doubling(points[i - 1], points[i]);
            result->low = std::min(result->low, single);
            result->high = std::max(result->high, single);
        }
    }
    return result;
}

StudyPlan plan(bool full)
{
    return plan_of_cases("stiffness", full, [](const StudyCase& study_case, StudyPlan& plan) {
        const StiffnessSweep sweep{option_of<Varied>(study_case.value<std::string>("varied")),
                                   study_case.value<std::string>("body"),
                                   study_case.value<std::vector<int>>("vertices", {0})};
        plan.runs.push_back(work_run(study_case.name, sweep, study_case.cost_s, record_stiffness));
    });
}

std::vector<StiffnessRow> rows_of_sweep(FinishedRuns finished, Varied varied)
{
    std::erase_if(finished.folders, [&](const std::string& run) {
        return !std::filesystem::path(run).filename().string().starts_with(name_of(varied));
    });
    return finished.rows(stiffness_columns, "stiffness.csv");
}

bool conclude(const FinishedRuns& finished)
{
    std::vector<StiffnessRow> stiffness_rows;
    analysis::CsvTable exponents{{}};
    for (const auto& [varied, name] : OptionNames<Varied>::table) {
        const std::vector<StiffnessRow> swept = rows_of_sweep(finished, varied);
        std::ranges::copy(swept, std::back_inserter(stiffness_rows));
        exponents.append(stiffness_exponents(swept, varied));
    }
    finished.write("stiffness.csv", stiffness_columns, stiffness_rows);
    finished.write("exponents.csv", exponents);
    return true;
}

}  // namespace

std::vector<analysis::Measurement> stiffness_ratios(const std::vector<StiffnessRow>& rows, Varied varied)
{
    std::vector<analysis::Measurement> ratios;
    for (const auto& [key, measured] : cases_of(rows, varied))
        if (const auto ratio = ratio_of(key, measured, varied)) ratios.push_back(*ratio);
    return ratios;
}

analysis::CsvTable stiffness_exponents(const std::vector<StiffnessRow>& rows, Varied varied)
{
    analysis::CsvTable exponents(
        {"varied", "body", "deformer", "vertices", "k_stretch", "young_pa", "iterations", "time_step_s", "load",
         "ladder", "first", "last", "points", "left_out", "exponent", "exponent_low", "exponent_high"},
        "exponents.csv");
    const auto shown = [varied](double x) { return varied == Varied::time_step ? 1e3 / x : x; };  // a time step [ms]
    for (const auto& [key, measured] : cases_of(rows, varied)) {
        if (measured.series.empty() || measured.series.begin()->second.size() < 2) continue;
        std::vector<double> x, stiffness;
        for (const Point& point : measured.series.begin()->second) {
            x.push_back(point.x);
            stiffness.push_back(point.stiffness);
        }
        const analysis::Interval slope = analysis::observed_order(x, stiffness);
        analysis::CsvTable::NamedCells cells = {
            {"varied", varied},          {"first", shown(x.front())},     {"last", shown(x.back())},
            {"points", slope.n},         {"left_out", measured.left_out}, {"exponent", slope.estimate},
            {"exponent_low", slope.low}, {"exponent_high", slope.high}};
        for (const analysis::CaseKeyField& field : analysis::case_key_fields())
            if (field.is_set(key)) cells.emplace_back(field.name, value_text(field, key));
        exponents.add(cells);
    }
    return exponents;
}

Study stiffness_study()
{
    return {"stiffness", plan, quick_and_full, conclude};
}

}  // namespace experiments
