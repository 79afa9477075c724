// Intervals for the mean of a series of frames, whose neighbours resemble each other: moving-block bootstrap (Kunsch 1989), percentile
// interval. Percentile intervals of short series are somewhat too narrow; a series without spread gives an interval without width.
//   const Interval loss = bootstrap_mean(loss_pct);            // loss.low .. loss.high at 95 %
//   const Interval share = bootstrap_share(frame_holds);       // share of frames, 0 to 1
#pragma once

#include <vector>

namespace analysis {

// A figure and how sure it is, in its own unit; NaN bounds: not known.
struct Interval {
    double estimate = 0.0, low = 0.0, high = 0.0;  // the figure and its bounds
    double level = 0.95;                           // of confidence, two-sided
    int n = 0;                                     // samples
    int block = 0;                                 // length of the blocks; 0: no bootstrap
};

// The same options and series give the same interval to the bit.
struct BootstrapOptions {
    double level = 0.95;            // 0 to 1, of confidence
    int resamples = 2000;           // series drawn
    unsigned long seed = 20140528;  // of GSL's mt19937
    int block = 0;                  // 0: chosen by `block_length`
    // Of the figures behind a share [samples]: where every sample holds, or none, the bootstrap sees no spread; the exact binomial bound
    // (Clopper and Pearson 1934) of n / autocorrelation_time independent samples is taken instead.
    double autocorrelation_time = 1.0;
};

// The length that minimises the error of the bootstrapped variance (Politis and White 2004) for a first-order autoregressive series with
// the integrated autocorrelation time of this one: (3/2)^(1/3) ((tau^2 - 1) / (2 tau))^(2/3) n^(1/3), between 1 and n / 2.
int block_length(const std::vector<double>& series);

// NaN bounds for fewer than two samples or values that are not finite.
Interval bootstrap_mean(const std::vector<double>& series, const BootstrapOptions& options = {});
// The share of samples that hold, 0 to 1; see autocorrelation_time where all hold, or none.
Interval bootstrap_share(const std::vector<bool>& holds, const BootstrapOptions& options = {});

}  // namespace analysis
