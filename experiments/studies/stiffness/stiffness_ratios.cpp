#include "experiments/studies/stiffness/stiffness_ratios.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace experiments {
namespace {

struct Window {
    double first, last;  // of x
};

double x_of(const StiffnessRow& row, Varied varied)
{
    switch (varied) {
        case Varied::iterations:
            return row.setting.iterations;
        case Varied::time_step:
            return 1.0 / row.setting.time_step_s;
        case Varied::resolution:
            return row.vertices;
    }
    return 0.0;
}

Window beside_the_paper(Varied varied)
{
    if (varied == Varied::iterations) return {12.0, 48.0};
    if (varied == Varied::time_step) return {1.0 / 0.02, 1.0 / 0.005};
    return {0.0, 1e9};
}

const char* deformer_of(Method method)
{
    if (method == Method::exponent) return "pbs_exponent";
    if (method == Method::xpbd_forgetting) return "xpbd_forgetting_multipliers";
    if (method == Method::xpbd_small_steps) return "xpbd_small_steps";
    return is_xpbd(method) ? "xpbd" : "pbs";
}

std::string quantity_of(Varied varied)
{
    return varied == Varied::iterations  ? "stiffness_ratio_at_twice_iterations"
           : varied == Varied::time_step ? "stiffness_ratio_at_half_time_step"
                                         : "stiffness_ratio_at_twice_resolution";
}

// Everything that is not varied, except for a repetition in another order or on the second ladder.
analysis::CaseKey key_of(const StiffnessRow& row, Varied varied)
{
    const StiffnessSetting& setting = row.setting;
    analysis::CaseKey key = {.body = row.body, .deformer = deformer_of(setting.method), .load = row.load};
    if (is_xpbd(setting.method))
        key.young_pa = setting.young_pa;
    else
        key.k_stretch = setting.k_stretch;
    if (varied != Varied::iterations) key.iterations = setting.iterations;
    if (varied != Varied::time_step) key.time_step_s = setting.time_step_s;
    if (varied != Varied::resolution) key.vertices = row.vertices;
    if (row.by == "stepped") key.ladder = row.by;
    return key;
}

struct Point {
    double x = 0.0, stiffness = 0.0;
};
using Series = std::map<std::string, std::vector<Point>>;  // of a case, by order and ladder

struct Case {
    analysis::CaseKey key;
    Series series;
    int left_out = 0;
};

std::map<std::string, Case> cases_of(const std::vector<StiffnessRow>& rows, Varied varied)
{
    std::map<std::string, Case> cases;
    for (const StiffnessRow& row : rows) {
        const analysis::CaseKey key = key_of(row, varied);
        Case& found = cases[text_of(key)];
        found.key = key;
        const bool usable = row.converged && std::isfinite(row.stiffness_n_m) && row.stiffness_n_m > 0.0;
        found.left_out += !usable;
        if (usable) found.series[fmt::format("{} {}", row.setting.order_seed, row.mesh)].push_back({x_of(row, varied), row.stiffness_n_m});
    }
    for (auto& [name, found] : cases)
        for (auto& [key, points] : found.series)
            std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
    return cases;
}

std::vector<Point> within(const std::vector<Point>& points, const Window& window)
{
    constexpr double rounding = 1e-9;
    std::vector<Point> kept;
    for (const Point& point : points)
        if (point.x >= window.first * (1.0 - rounding) && point.x <= window.last * (1.0 + rounding)) kept.push_back(point);
    return kept;
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

std::optional<analysis::Measurement> ratio_of(const Case& measured, Varied varied)
{
    std::optional<analysis::Measurement> result;
    for (const auto& [key, all] : measured.series) {  // file order on the wanted meshes comes first
        const std::vector<Point> points = within(all, beside_the_paper(varied));
        if (points.size() < 2) continue;
        const double overall = for_one_doubling(points.front(), points.back());
        if (!result)
            result = {
                "C11", quantity_of(varied), over_range(measured.key, varied, points.front().x, points.back().x), overall, overall, overall,
                "1"};
        for (std::size_t i = 1; i < points.size(); ++i) {
            const double single = for_one_doubling(points[i - 1], points[i]);
            result->low = std::min(result->low, single);
            result->high = std::max(result->high, single);
        }
    }
    return result;
}

}  // namespace

std::vector<analysis::Measurement> stiffness_ratios(const std::vector<StiffnessRow>& rows, Varied varied)
{
    std::vector<analysis::Measurement> measured;
    for (const auto& [of, found] : cases_of(rows, varied))
        if (const auto ratio = ratio_of(found, varied)) measured.push_back(*ratio);
    return measured;
}

std::vector<StiffnessExponent> stiffness_exponents(const std::vector<StiffnessRow>& rows, Varied varied)
{
    std::vector<StiffnessExponent> exponents;
    for (const auto& [of, found] : cases_of(rows, varied)) {
        if (found.series.empty() || found.series.begin()->second.size() < 2) continue;
        std::vector<double> x, stiffness;
        for (const Point& point : found.series.begin()->second) x.push_back(point.x), stiffness.push_back(point.stiffness);
        exponents.push_back({of, x.front(), x.back(), found.left_out, analysis::observed_order(x, stiffness)});
    }
    return exponents;
}

}  // namespace experiments
