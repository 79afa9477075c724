#include "analysis/statistics/statistics.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_statistics_double.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

namespace analysis {
namespace {

bool has_nan(const std::vector<double>& values)
{
    return std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

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

const std::vector<std::string> settings = {"scene", "deformer", "variant", "order", "precision", "iterations"};
// each [%]
const std::array<std::string, 4> quantities = {"volume_change", "volume_abs_change", "error_l2", "error_joint"};
const std::array<std::pair<std::string, double>, 5> shares = {
    {{"least", 0.0}, {"p10", 0.1}, {"median", 0.5}, {"p90", 0.9}, {"most", 1.0}}};

std::vector<double> finite_values(const CsvTable& frames, const std::string& column)
{
    std::vector<double> values = frames.has_column(column) ? frames.known_numbers(column) : std::vector<double>{};
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    return values;
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

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y)
{
    const std::size_t n = std::min(x.size(), y.size());
    if (n < 2 || has_nan(x) || has_nan(y)) return not_known;
    std::vector<double> work(2 * n);
    constexpr double places =
        1e12;  // a correlation of -0.9 is not to miss a bound of -0.9 by the last bits of GSL's square roots
    return std::round(places * gsl_stats_spearman(x.data(), 1, y.data(), 1, n, work.data())) / places;
}

Interval ratio(const Interval& a, const Interval& b)
{
    return {a.estimate / b.estimate, a.low / b.high, a.high / b.low};
}

Interval rank_correlation_without_one(const std::vector<double>& x, const std::vector<double>& y)
{
    const double all = rank_correlation(x, y);
    Interval interval{.estimate = all, .low = all, .high = all, .n = static_cast<int>(x.size())};
    for (std::ptrdiff_t left_out = 0; left_out < std::ssize(x); ++left_out) {
        std::vector<double> other_x = x, other_y = y;
        other_x.erase(other_x.begin() + left_out);
        other_y.erase(other_y.begin() + left_out);
        const double without = rank_correlation(other_x, other_y);
        interval.low = std::min(interval.low, without);
        interval.high = std::max(interval.high, without);
    }
    return interval;
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
    for (std::size_t lag = 1; lag < n && static_cast<double>(lag) < 5.0 * tau; ++lag)
        tau += 2.0 * covariance(lag) / variance;
    return std::max(tau, 1.0);
}

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

Interval share_interval(int counted, int cases, double level)
{
    const double tail = (1.0 - level) / 2.0;
    Interval share{.estimate = double(counted) / cases, .low = 0.0, .high = 1.0, .level = level, .n = cases};
    if (counted > 0) share.low = gsl_cdf_beta_Pinv(tail, counted, cases - counted + 1.0);
    if (counted < cases) share.high = gsl_cdf_beta_Pinv(1.0 - tail, counted + 1.0, cases - counted);
    return share;
}

Interval bootstrap_share_of_groups(const std::vector<std::string>& groups, const std::vector<bool>& holds,
                                   const BootstrapOptions& options)
{
    std::map<std::string, std::array<double, 2>> counts;  // of each group: cases that hold, cases
    for (std::size_t i = 0; i < groups.size(); ++i) {
        auto& [held, all] = counts[groups[i]];
        held += holds[i];
        ++all;
    }
    Interval share{.estimate = mean(std::vector<double>(holds.begin(), holds.end())),
                   .low = not_known,
                   .high = not_known,
                   .level = options.level,
                   .n = static_cast<int>(holds.size())};
    if (counts.size() < 2) return share;
    std::vector<std::array<double, 2>> drawn_from;
    for (const auto& [group, count] : counts) drawn_from.push_back(count);
    const Random random(gsl_rng_alloc(gsl_rng_mt19937), gsl_rng_free);
    gsl_rng_set(random.get(), options.seed);
    std::vector<double> shares(static_cast<std::size_t>(options.resamples));
    for (double& value : shares) {
        double held = 0.0, all = 0.0;
        for (std::size_t drawn = 0; drawn < drawn_from.size(); ++drawn) {
            const auto& count = drawn_from[gsl_rng_uniform_int(random.get(), drawn_from.size())];
            held += count[0];
            all += count[1];
        }
        value = held / all;
    }
    share.low = quantile(shares, (1.0 - options.level) / 2.0);
    share.high = quantile(shares, (1.0 + options.level) / 2.0);
    return share;
}

double binomial_tail(int counted, int cases, double q)
{
    return counted <= 0 ? 1.0 : gsl_cdf_binomial_Q(static_cast<unsigned>(counted - 1), q, static_cast<unsigned>(cases));
}

CsvTable frame_statistics(const CsvTable& metrics)
{
    std::vector<std::string> columns = settings;
    columns.emplace_back("frames");
    for (const std::string& quantity : quantities)
        for (const auto& [name, share] : shares) columns.push_back(quantity + "_" + name + "_pct");
    CsvTable statistics(columns, "frame_statistics.csv");
    for (const CsvTable& frames : metrics.groups(settings)) {
        CsvTable::NamedCells cells = {{"frames", frames.rows()}};
        for (const std::string& setting : settings) cells.emplace_back(setting, frames[0].text(setting));
        for (const std::string& quantity : quantities)
            if (const std::vector<double> values = finite_values(frames, quantity + "_pct"); !values.empty())
                for (const auto& [name, share] : shares)
                    cells.emplace_back(quantity + "_" + name + "_pct", quantile(values, share));
        statistics.add(cells);
    }
    return statistics;
}

}  // namespace analysis
