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

// Only the jiggling zone on what the paper's solver moves is what the paper runs.
std::string suffix_of(Method method, const std::string& load)
{
    if (method == Method::exponent) return ", exponent";
    if (method == Method::xpbd_forgetting) return ", xpbd, multipliers forgotten";
    if (is_xpbd(method)) return ", xpbd";
    return load == "zone" ? "" : ", flesh held";
}

std::string quantity_of(Varied varied, const std::string& suffix)
{
    const char* changed = varied == Varied::iterations  ? "twice the iterations over at the once"
                          : varied == Varied::time_step ? "half the time step over at the whole"
                                                        : "twice the resolution over at the once";
    return fmt::format("effective stiffness at {}{}", changed, suffix);
}

std::string material_of(const StiffnessSetting& setting)
{
    if (setting.method == Method::xpbd) return fmt::format("{:.4g} kPa", 1e-3 * setting.young_pa);
    if (setting.method == Method::xpbd_small_steps) return fmt::format("{:.4g} kPa in small steps", 1e-3 * setting.young_pa);
    if (setting.method == Method::xpbd_forgetting) return fmt::format("{:.4g} kPa, multipliers forgotten", 1e-3 * setting.young_pa);
    return fmt::format("k_stretch {:.4g}{}", setting.k_stretch, setting.method == Method::exponent ? " with the exponent" : "");
}

// Everything that is not varied, nor a repetition in another order or on the second ladder.
std::string case_of(const StiffnessRow& row, Varied varied)
{
    std::string text = fmt::format("{}, {}, {}", row.body, row.load, material_of(row.setting));
    if (varied != Varied::iterations) text += fmt::format(", {} iterations", row.setting.iterations);
    if (varied != Varied::time_step) text += fmt::format(", {:.4g} ms", 1e3 * row.setting.time_step_s);
    if (varied != Varied::resolution) text += fmt::format(", {} vertices", row.vertices);
    return text + (row.by == "stepped" ? ", stepped" : "");
}

struct Point {
    double x = 0.0, stiffness = 0.0;
};
using Series = std::map<std::string, std::vector<Point>>;  // of a case, by order and ladder

struct Case {
    std::string suffix;  // of the figure's name
    Series series;
    int left_out = 0;
};

std::map<std::string, Case> cases_of(const std::vector<StiffnessRow>& rows, Varied varied)
{
    std::map<std::string, Case> cases;
    for (const StiffnessRow& row : rows) {
        Case& found = cases[case_of(row, varied)];
        found.suffix = suffix_of(row.setting.method, row.load);
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

std::optional<analysis::Measurement> ratio_of(const std::string& of, const Case& measured, Varied varied)
{
    std::optional<analysis::Measurement> result;
    for (const auto& [key, all] : measured.series) {  // file order on the wanted meshes comes first
        const std::vector<Point> points = within(all, beside_the_paper(varied));
        if (points.size() < 2) continue;
        const double overall = for_one_doubling(points.front(), points.back());
        if (!result) {
            const std::string to = varied == Varied::resolution ? fmt::format("{} to {} vertices", points.front().x, points.back().x)
                                   : varied == Varied::iterations
                                       ? fmt::format("{} to {} iterations", points.front().x, points.back().x)
                                       : fmt::format("{:.4g} to {:.4g} ms", 1e3 / points.front().x, 1e3 / points.back().x);
            result = {"C11", quantity_of(varied, measured.suffix), of + ", " + to, overall, overall, overall, "1"};
        }
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
        if (const auto ratio = ratio_of(of, found, varied)) measured.push_back(*ratio);
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
