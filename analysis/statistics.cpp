#include "analysis/statistics.hpp"

#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

bool has_nan(const std::vector<double>& values)
{
    return std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

}  // namespace

double mean(const std::vector<double>& values)
{
    return values.empty() ? not_known : gsl_stats_mean(values.data(), 1, values.size());
}

double median(const std::vector<double>& values)
{
    return quantile(values, 0.5);
}

double quantile(std::vector<double> values, double share)
{
    if (values.empty() || has_nan(values)) return not_known;
    std::sort(values.begin(), values.end());
    return gsl_stats_quantile_from_sorted_data(values.data(), 1, values.size(), share);
}

double standard_deviation(const std::vector<double>& values)
{
    return values.size() < 2 ? not_known : gsl_stats_sd(values.data(), 1, values.size());
}

double standard_error(const std::vector<double>& values)
{
    return standard_deviation(values) / std::sqrt(static_cast<double>(values.size()));
}

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y)
{
    const std::size_t n = std::min(x.size(), y.size());
    if (n < 2 || has_nan(x) || has_nan(y)) return not_known;
    std::vector<double> work(2 * n);
    return gsl_stats_spearman(x.data(), 1, y.data(), 1, n, work.data());
}

double integrated_autocorrelation_time(const std::vector<double>& series)
{
    const std::size_t n = series.size();
    const double centre = mean(series);
    const auto covariance = [&](std::size_t lag) {
        double sum = 0.0;
        for (std::size_t i = 0; i + lag < n; ++i) sum += (series[i] - centre) * (series[i + lag] - centre);
        return sum / static_cast<double>(n);
    };
    const double variance = n < 2 ? 0.0 : covariance(0);
    if (!(variance > 0.0)) return 1.0;
    double tau = 1.0;
    for (std::size_t lag = 1; lag < n && static_cast<double>(lag) < 5.0 * tau; ++lag) tau += 2.0 * covariance(lag) / variance;
    return std::max(tau, 1.0);
}

}  // namespace analysis
