#include "analysis/bootstrap.hpp"

#include "analysis/statistics.hpp"

#include <gsl/gsl_rng.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace analysis {
namespace {

using Random = std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)>;

// The mean of as many samples as the series has, drawn in blocks of neighbours; the last block is shortened to fit.
double resampled_mean(const std::vector<double>& series, std::size_t block, gsl_rng* random)
{
    double sum = 0.0;
    for (std::size_t drawn = 0; drawn < series.size();) {
        const std::size_t first = gsl_rng_uniform_int(random, series.size() - block + 1);
        const std::size_t count = std::min(block, series.size() - drawn);
        for (std::size_t i = first; i < first + count; ++i) sum += series[i];
        drawn += count;
    }
    return sum / static_cast<double>(series.size());
}

}  // namespace

int block_length(const std::vector<double>& series)
{
    const double tau = integrated_autocorrelation_time(series), n = static_cast<double>(series.size());
    const double length = std::cbrt(1.5 * n) * std::pow((tau * tau - 1.0) / (2.0 * tau), 2.0 / 3.0);
    return static_cast<int>(std::clamp(std::ceil(length), 1.0, std::max(1.0, std::floor(n / 2.0))));
}

Interval bootstrap_mean(const std::vector<double>& series, const BootstrapOptions& options)
{
    Interval interval{mean(series), not_known, not_known, options.level, static_cast<int>(series.size()), 0};
    if (series.size() < 2 || !std::isfinite(interval.estimate)) return interval;
    interval.block = options.block > 0 ? std::min(options.block, interval.n) : block_length(series);

    const Random random(gsl_rng_alloc(gsl_rng_mt19937), gsl_rng_free);
    gsl_rng_set(random.get(), options.seed);
    std::vector<double> means(static_cast<std::size_t>(options.resamples));
    for (double& value : means) value = resampled_mean(series, static_cast<std::size_t>(interval.block), random.get());
    interval.low = quantile(means, (1.0 - options.level) / 2.0);
    interval.high = quantile(means, (1.0 + options.level) / 2.0);
    return interval;
}

Interval bootstrap_share(const std::vector<bool>& holds, const BootstrapOptions& options)
{
    Interval interval = bootstrap_mean(std::vector<double>(holds.begin(), holds.end()), options);
    if (interval.n < 2 || (interval.estimate > 0.0 && interval.estimate < 1.0)) return interval;
    const double independent = interval.n / std::max(1.0, options.autocorrelation_time);
    const double margin = 1.0 - std::pow((1.0 - options.level) / 2.0, 1.0 / independent);
    (interval.estimate > 0.0 ? interval.low : interval.high) = interval.estimate > 0.0 ? 1.0 - margin : margin;
    return interval;
}

}  // namespace analysis
