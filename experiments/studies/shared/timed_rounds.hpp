// Timings that can be compared: all variants by turns, A B C A B C ..., so that what disturbs the machine disturbs them alike; of each the
// median and the quartiles over the rounds. What a variant costs relative to another is the median of the ratios within a round, which a
// disturbance of the machine disturbs less than a ratio of medians.
//   const auto samples = take_turns({[&] { return seconds_of(a); }, [&] { return seconds_of(b); }}, {.seconds = 2.0});
//   spread_of(samples[0][0]).median
//   spread_of_ratios(samples[0][0], samples[1][0]).median   // a over b
#pragma once

#include "experiments/process/cpu_clock.hpp"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>
#include <vector>

namespace experiments {

struct Rounds {
    double seconds = 3.0;  // so long at most, once the fewest are done [s]
    int fewest = 3, most = 61;
};

nlohmann::json to_json(const Rounds& rounds);

struct Spread {
    double median = 0.0, lower = 0.0, upper = 0.0;  // lower, upper: quartiles
    int rounds = 0;
};

// One timing of a variant: it measures itself, and returns what it measured, always as many numbers.
using TimedVariant = std::function<std::vector<double>()>;

// samples[variant][which number][round]. A first round warms up and is not kept.
std::vector<std::vector<std::vector<double>>> take_turns(const std::vector<TimedVariant>& variants, const Rounds& rounds);

Spread spread_of(const std::vector<double>& samples);
Spread spread_of_ratios(const std::vector<double>& numerator, const std::vector<double>& denominator, double factor = 1.0);  // by round
Spread scaled(const Spread& spread, double factor);

// The median under `name`, its quartiles under "quartiles", and the number of rounds.
void put_spread(nlohmann::json& json, const std::string& name, const Spread& spread);

// What the calling thread's work takes of its processor [s].
template <typename Work>
double cpu_seconds(const Work& work)
{
    const double start = thread_cpu_s();
    work();
    return thread_cpu_s() - start;
}

}  // namespace experiments
