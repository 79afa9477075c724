#include "experiments/studies/work_precision/stiffness_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace experiments {
namespace {

constexpr double insensitive_share = 0.01;  // of the least error
constexpr int golden_sections = 8;          // each keeps 0.618 of a bracket of two octaves
constexpr double largest_log = 12.0;        // factors up to 4096 and down to its inverse
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

using Errors = std::map<double, double>;  // at the logarithms of the factors; infinite where there is no answer

Errors::const_iterator least_of(const Errors& errors)
{
    return std::ranges::min_element(errors, {}, [](const auto& one) { return one.second; });
}

// Whether the nearest factor is the first or the last one tried. Neither where there is no answer.
bool is_first(const Errors& errors)
{
    return least_of(errors) == errors.begin() && errors.begin()->second < none;
}
bool is_last(const Errors& errors)
{
    return least_of(errors) == std::prev(errors.end()) && errors.rbegin()->second < none;
}

bool is_insensitive(const Errors& errors)
{
    const double least = least_of(errors)->second;
    const double most = std::ranges::max_element(errors, {}, [](const auto& one) { return one.second; })->second;
    return most < none && most - least <= insensitive_share * least;
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
    Errors errors;
    const auto error_at = [&](double log2_factor) {
        ++found.tried;
        return error_pct(std::exp2(log2_factor)).value_or(none);
    };
    const auto try_factor = [&](double log2_factor) {
        if (!errors.contains(log2_factor)) errors[log2_factor] = error_at(log2_factor);
    };
    const double last_log = std::min(std::log2(highest), largest_log);
    for (const double factor : factor_grid()) try_factor(std::min(std::log2(factor), last_log));
    const bool has_effect = !is_insensitive(errors);
    while (has_effect && is_first(errors) && errors.begin()->first > -largest_log) try_factor(errors.begin()->first - 1.0);
    while (has_effect && is_last(errors) && errors.rbegin()->first < last_log) try_factor(std::min(errors.rbegin()->first + 1.0, last_log));

    if (const auto one = errors.find(0.0); one != errors.end() && one->second < none) found.error_at_1_pct = one->second;
    found.lowest_tried = std::exp2(errors.begin()->first);
    found.highest_tried = std::exp2(errors.rbegin()->first);
    const auto least = least_of(errors);
    if (!(least->second < none)) return found;
    found.error_pct = least->second;
    found.outcome = ThetaOutcome::insensitive;
    if (!has_effect) return found;
    if (is_first(errors) || is_last(errors)) {
        const bool is_refused_further = is_last(errors) && last_log < largest_log;
        found.outcome = is_refused_further ? ThetaOutcome::highest_allowed : ThetaOutcome::end_of_grid;
        return found;
    }
    found.outcome = ThetaOutcome::found;
    found.theta = std::exp2(least->first);
    const auto [log, error] = golden_minimum(error_at, std::prev(least)->first, std::next(least)->first);
    if (error < *found.error_pct) found.theta = std::exp2(log), found.error_pct = error;
    return found;
}

}  // namespace experiments
