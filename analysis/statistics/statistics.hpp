// Plain statistics of a series, by GSL. The result is NaN if there are too few values (none, or one for a spread).
#pragma once

#include "analysis/records/tables.hpp"

#include <cstddef>
#include <limits>
#include <vector>

namespace analysis {

// NaN, for values that could not be computed
inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

double mean(const std::vector<double>& values);    // NaN if a value is NaN
double median(const std::vector<double>& values);  // quantile at 0.5
// linear between the order statistics at share (n - 1), 0 <= share <= 1
double quantile(std::vector<double> values, double share);
double standard_deviation(const std::vector<double>& values);  // n - 1 in the denominator

// Spearman's rank correlation, rounded to 12 decimals; it is 1 if y rises with x throughout. NaN for fewer than two
// pairs.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

// An estimate with its interval, in the unit of the series. NaN bounds mean that the interval is not known.
struct Interval {
    double estimate = 0.0, low = 0.0, high = 0.0;  // the estimated value and its bounds
    double level = 0.95;                           // confidence level, two-sided
    int n = 0;                                     // number of samples
    int block = 0;                                 // length of the blocks; 0: no bootstrap was made
};

// The quotient of two positive estimates, from the least to the largest one that their intervals allow.
Interval ratio(const Interval& a, const Interval& b);

// The rank correlation of all pairs, with its least and its largest value when any one of the pairs is left out.
Interval rank_correlation_without_one(const std::vector<double>& x, const std::vector<double>& y);

// Integrated autocorrelation time in samples, 1 + 2 sum rho_k over the first window W >= 5 tau (Sokal). The mean of n
// samples is as precise as that of n / tau independent ones. At least 1; 1 for a series without spread.
double integrated_autocorrelation_time(const std::vector<double>& series);

// The same options and the same series give the same interval to the bit.
struct BootstrapOptions {
    double level = 0.95;            // confidence level, 0 to 1
    int resamples = 2000;           // number of series drawn
    unsigned long seed = 20140528;  // seed of GSL's mt19937
    int block = 0;                  // length of the blocks; 0: `block_length` chooses it
    // Autocorrelation time of the values behind a share [samples]. Where every sample holds, or none, the bootstrap
    // sees no spread. The exact binomial bound (Clopper and Pearson 1934) of n / autocorrelation_time independent
    // samples replaces it there.
    double autocorrelation_time = 1.0;
};

// The block length that minimises the error of the bootstrapped variance (Politis and White 2004) for a first-order
// autoregressive series with the same integrated autocorrelation time: (3/2)^(1/3) ((tau^2 - 1) / (2 tau))^(2/3)
// n^(1/3), between 1 and n / 2.
int block_length(const std::vector<double>& series);

// Confidence intervals for the mean of a series of frames, whose neighbours are correlated: moving-block bootstrap
// (Kunsch 1989), percentile interval. Percentile intervals of short series are somewhat too narrow. A series without
// spread has an interval of width zero.
//   const Interval loss = bootstrap_mean(loss_pct);            // loss.low .. loss.high at 95 %
//   const Interval share = bootstrap_share(frame_holds);       // share of frames, 0 to 1
// The bounds are NaN for fewer than two samples and for values that are not finite.
Interval bootstrap_mean(const std::vector<double>& series, const BootstrapOptions& options = {});
// The share of samples that hold, 0 to 1. autocorrelation_time matters only where all samples hold, or none.
Interval bootstrap_share(const std::vector<bool>& holds, const BootstrapOptions& options = {});

// The interval of Clopper and Pearson for a share of independent cases: it contains each share p under which `counted`
// or fewer, and `counted` or more, of `cases` have at least the probability (1 - level) / 2. Its coverage is never
// below `level`.
//   const Interval share = share_interval(3, 18);   // 3 / 18, between 0.036 and 0.41
// 0 <= counted <= cases, cases > 0.
Interval share_interval(int counted, int cases, double level = 0.95);

// A share of cases that belong to groups, such as bodies, whose cases are alike: the bootstrap draws whole groups
// (percentile interval, with the resamples and the seed of `options`). NaN bounds for fewer than two groups.
//   const Interval share = bootstrap_share_of_groups({"limb", "limb", "man"}, {true, true, false});
// groups, holds: #cases each.
Interval bootstrap_share_of_groups(const std::vector<std::string>& groups, const std::vector<bool>& holds,
                                   const BootstrapOptions& options = {});

// The probability that at least `counted` of so many independent cases hold if each does with probability q (GSL's
// binomial distribution).
double binomial_tail(int counted, int cases, double q);

// Order statistics over the frames of a table of metrics. One row per deformer and setting:
//   scene, deformer, variant, order, precision, iterations, frames
//   volume_change_least_pct, _p10_pct, _median_pct, _p90_pct, _most_pct   likewise volume_abs_change, error_l2,
//                                                                         error_joint
// A statistic leaves out frames that lack its quantity. If all do, its cells are empty.
//   frame_statistics(metrics).write("frame_statistics.csv");
// metrics: the table metrics.csv.
CsvTable frame_statistics(const CsvTable& metrics);

}  // namespace analysis
