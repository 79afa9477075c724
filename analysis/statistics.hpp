// Plain statistics of a series, by GSL. A figure of too few values (none; one for a spread) is NaN.
#pragma once

#include <limits>
#include <vector>

namespace analysis {

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();  // NaN, for figures that could not be computed

double mean(const std::vector<double>& values);                // NaN where a value is
double median(const std::vector<double>& values);              // quantile at 0.5
double quantile(std::vector<double> values, double share);     // linear between the order statistics at share (n - 1), 0 <= share <= 1
double standard_deviation(const std::vector<double>& values);  // n - 1 in the denominator
double standard_error(const std::vector<double>& values);      // of the mean of independent values

// Spearman's, of pairs: 1 where y rises with x throughout. NaN for fewer than two pairs.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

// Integrated autocorrelation time in samples, 1 + 2 sum rho_k over the first window W >= 5 tau (Sokal): the mean of n samples is worth that
// of n / tau independent ones. At least 1; 1 for a series without spread.
double integrated_autocorrelation_time(const std::vector<double>& series);

}  // namespace analysis
