#include "experiments/studies/shared/path_figures.hpp"

#include "analysis/line_fit.hpp"
#include "analysis/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

Reached reached(const IterationPath& path, double Look::*figure, double bound)
{
    Reached result{path.looks.back().iteration, false};
    for (auto look = path.looks.rbegin(); look != path.looks.rend() && (*look).*figure <= bound; ++look) result = {look->iteration, true};
    return result;
}

}  // namespace

double floor_of(const std::vector<IterationPath>& paths)
{
    double floor = analysis::not_known;
    for (const IterationPath& path : paths)
        if (path.finite && !(path.looks.back().combined >= floor)) floor = path.looks.back().combined;
    return floor;
}

Reached reached_residual(const IterationPath& path, double floor)
{
    return reached(path, &Look::combined, std::max((1.0 + residual_tolerance) * floor, satisfied_residual));
}

Reached reached_volume(const IterationPath& path)
{
    return reached(path, &Look::volume_abs_change_pct, volume_tolerance_pct);
}

Rate rate_of(const IterationPath& path, double floor)
{
    constexpr double unchanged = 0.01;
    const Look &last = path.looks.back(), &half = look_at(path, last.iteration / 2);
    Rate rate;
    const bool is_rounding = last.combined < satisfied_residual;
    if (is_rounding || std::abs(last.combined / half.combined - 1.0) < unchanged) {
        floor = last.combined;
        rate.stalls_at = reached_residual(path, floor).iterations;
    }
    std::vector<double> iterations, excess;
    for (const Look& look : path.looks)
        if (look.iteration > 0 && look.iteration <= rate.stalls_at.value_or(last.iteration) && look.combined > floor) {
            iterations.push_back(look.iteration);
            excess.push_back(std::log(look.combined - floor));
        }
    rate.rate.estimate = rate.rate.low = rate.rate.high = rate.log_rms_off = analysis::not_known;
    if (is_rounding || iterations.size() < 3) return rate;
    const analysis::LineFit fit = analysis::fit_line(iterations, excess);
    rate.log_rms_off = fit.residual_rms;
    rate.rate = fit.slope;
    for (double* bound : {&rate.rate.estimate, &rate.rate.low, &rate.rate.high}) *bound = std::exp(*bound);
    return rate;
}

const Look& look_at(const IterationPath& path, int iteration)
{
    const auto after = std::upper_bound(path.looks.begin(), path.looks.end(), iteration,
                                        [](int wanted, const Look& look) { return wanted < look.iteration; });
    return after == path.looks.begin() ? path.looks.front() : *std::prev(after);
}

const Look& nearest_to_reference(const IterationPath& path)
{
    return *std::min_element(path.looks.begin(), path.looks.end(),
                             [](const Look& a, const Look& b) { return a.error_joint_pct < b.error_joint_pct; });
}

}  // namespace experiments
