// Confidence intervals for the mean of a series of frames, whose neighbours are correlated: moving-block bootstrap (Kunsch 1989),
// percentile interval. Percentile intervals of short series are somewhat too narrow. A series without spread has an interval of width zero.
//   const Interval loss = bootstrap_mean(loss_pct);            // loss.low .. loss.high at 95 %
//   const Interval share = bootstrap_share(frame_holds);       // share of frames, 0 to 1
#pragma once

#include <vector>

namespace analysis {

// An estimate with its confidence interval, in the unit of the series. NaN bounds mean that the interval is not known.
struct Interval {
    double estimate = 0.0, low = 0.0, high = 0.0;  // the estimated value and its bounds
    double level = 0.95;                           // confidence level, two-sided
    int n = 0;                                     // number of samples
    int block = 0;                                 // length of the blocks; 0: no bootstrap was made
};

// The same options and the same series give the same interval to the bit.
struct BootstrapOptions {
    double level = 0.95;            // confidence level, 0 to 1
    int resamples = 2000;           // number of series drawn
    unsigned long seed = 20140528;  // seed of GSL's mt19937
    int block = 0;                  // length of the blocks; 0: `block_length` chooses it
    // Autocorrelation time of the values behind a share [samples]. Where every sample holds, or none, the bootstrap sees no spread. The
    // exact binomial bound (Clopper and Pearson 1934) of n / autocorrelation_time independent samples replaces it there.
    double autocorrelation_time = 1.0;
};

// The block length that minimises the error of the bootstrapped variance (Politis and White 2004) for a first-order autoregressive series
// with the same integrated autocorrelation time: (3/2)^(1/3) ((tau^2 - 1) / (2 tau))^(2/3) n^(1/3), between 1 and n / 2.
int block_length(const std::vector<double>& series);

// The bounds are NaN for fewer than two samples and for values that are not finite.
Interval bootstrap_mean(const std::vector<double>& series, const BootstrapOptions& options = {});
// The share of samples that hold, 0 to 1. autocorrelation_time matters only where all samples hold, or none.
Interval bootstrap_share(const std::vector<bool>& holds, const BootstrapOptions& options = {});

}  // namespace analysis
