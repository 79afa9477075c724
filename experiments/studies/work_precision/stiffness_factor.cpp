#include "experiments/studies/work_precision/stiffness_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace experiments {
namespace {

constexpr double insensitive_share = 0.01;  // of the least error
constexpr int golden_sections = 8;          // each keeps 0.618 of a bracket of two octaves
constexpr double none = std::numeric_limits<double>::infinity();

// The minimum of a function with one minimum between the two ends.
std::pair<double, double> golden_minimum(const std::function<double(double)>& value, double low, double high)
{
    const double share = 1.0 / std::numbers::phi;
    double left = high - share * (high - low), right = low + share * (high - low);
    double at_left = value(left), at_right = value(right);
    for (int section = 2; section < golden_sections; ++section) {
        if (at_left <= at_right) {
            high = right, right = left, at_right = at_left;
            left = high - share * (high - low), at_left = value(left);
        } else {
            low = left, left = right, at_left = at_right;
            right = low + share * (high - low), at_right = value(right);
        }
    }
    return at_left <= at_right ? std::pair(left, at_left) : std::pair(right, at_right);
}

}  // namespace

const std::vector<double>& factor_grid()
{
    static const std::vector<double> grid = {0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};
    return grid;
}

StiffnessFactor nearest_factor(const std::function<std::optional<double>(double factor)>& error_pct, double highest)
{
    StiffnessFactor found;
    const auto error_at = [&](double log2_factor) {
        ++found.tried;
        return error_pct(std::exp2(log2_factor)).value_or(none);
    };
    std::vector<double> logs, errors;
    for (const double factor : factor_grid())
        if (factor < highest) logs.push_back(std::log2(factor));
    if (std::isfinite(highest) && highest <= factor_grid().back()) logs.push_back(std::log2(highest));
    for (const double log : logs) errors.push_back(error_at(log));
    if (const auto one = std::find(logs.begin(), logs.end(), 0.0); one != logs.end() && errors[one - logs.begin()] < none)
        found.error_at_1_pct = errors[one - logs.begin()];
    const auto least = std::min_element(errors.begin(), errors.end());
    if (!(*least < none)) return found;
    const double most = *std::max_element(errors.begin(), errors.end());
    found.error_pct = *least;
    found.outcome = ThetaOutcome::insensitive;
    if (most - *least <= insensitive_share * *least) return found;
    const std::size_t best = least - errors.begin();
    const bool at_end = best == 0 || best + 1 == logs.size();
    found.outcome = at_end ? ThetaOutcome::end_of_grid : ThetaOutcome::found;
    found.theta = std::exp2(logs[best]);
    if (at_end) return found;
    const auto [log, error] = golden_minimum(error_at, logs[best - 1], logs[best + 1]);
    if (error < *found.error_pct) found.theta = std::exp2(log), found.error_pct = error;
    return found;
}

}  // namespace experiments
