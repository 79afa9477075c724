// Plain statistics of a series, by GSL. The result is NaN if there are too few values (none, or one for a spread).
#pragma once

#include <limits>
#include <vector>

namespace analysis {

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();  // NaN, for values that could not be computed

double mean(const std::vector<double>& values);                // NaN if a value is NaN
double median(const std::vector<double>& values);              // quantile at 0.5
double quantile(std::vector<double> values, double share);     // linear between the order statistics at share (n - 1), 0 <= share <= 1
double standard_deviation(const std::vector<double>& values);  // n - 1 in the denominator
double standard_error(const std::vector<double>& values);      // standard error of the mean of independent values

// Spearman's rank correlation: 1 if y rises with x throughout. NaN for fewer than two pairs.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

// Integrated autocorrelation time in samples, 1 + 2 sum rho_k over the first window W >= 5 tau (Sokal). The mean of n samples is as precise
// as that of n / tau independent ones. At least 1; 1 for a series without spread.
double integrated_autocorrelation_time(const std::vector<double>& series);

}  // namespace analysis
