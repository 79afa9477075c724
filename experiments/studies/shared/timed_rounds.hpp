// Timings that can be compared: all variants by turns, A B C A B C ..., so that what disturbs the machine disturbs them alike; of each the
// median and the quartiles over the rounds.
//   const auto samples = take_turns({[&] { return seconds_of(a); }, [&] { return seconds_of(b); }}, {.seconds = 2.0});
//   spread_of(samples[0]).median
#pragma once

#include <functional>
#include <vector>

namespace experiments {

struct Rounds {
    double seconds = 3.0;  // so long at most, once the fewest are done [s]
    int fewest = 3, most = 61;
};

struct Spread {
    double median = 0.0, lower = 0.0, upper = 0.0;  // lower, upper: quartiles
    int rounds = 0;
};

// One timing of a variant: it measures itself, and returns what it measured, always as many numbers.
using TimedVariant = std::function<std::vector<double>()>;

// samples[variant][which number][round]. A first round warms up and is not kept.
std::vector<std::vector<std::vector<double>>> take_turns(const std::vector<TimedVariant>& variants, const Rounds& rounds);

Spread spread_of(const std::vector<double>& samples);
Spread scaled(const Spread& spread, double factor);

}  // namespace experiments
