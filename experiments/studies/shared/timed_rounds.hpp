// Timings that can be compared. All variants take turns, A B C A B C ..., so that a disturbance of the machine meets
// them alike; each one has the median and the quartiles over the rounds. The cost of one variant relative to another is
// the median of the ratios within a round, which a disturbance changes less than a ratio of medians.
//   const auto samples = take_turns({[&] { return seconds_of(a); }, [&] { return seconds_of(b); }}, {.seconds = 2.0});
//   spread_of(samples[0][0]).median
//   spread_of_ratios(samples[0][0], samples[1][0]).median   // a over b
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/scene/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>
#include <vector>

namespace experiments {

struct Rounds {
    double seconds = 3.0;  // no round begins later than this, except the fewest [s]
    int fewest = 3, most = 61;
};

nlohmann::json to_json(const Rounds& rounds);

struct Spread {
    double median = 0.0, lower = 0.0, upper = 0.0;  // lower, upper: quartiles
    int rounds = 0;
};

// One timing of a variant. It measures itself and returns what it measured, the same number of values each time.
using TimedVariant = std::function<std::vector<double>()>;
using Samples = std::vector<std::vector<double>>;  // [value][round]

// The samples of each variant. A first round warms up and is not kept.
std::vector<Samples> take_turns(const std::vector<TimedVariant>& variants, const Rounds& rounds);

Spread spread_of(const std::vector<double>& samples);
// by round
Spread spread_of_ratios(const std::vector<double>& numerator, const std::vector<double>& denominator,
                        double factor = 1.0);
Spread scaled(const Spread& spread, double factor);

// The median under `name`, its quartiles under "quartiles", and the number of rounds.
void put_spread(nlohmann::json& json, const std::string& name, const Spread& spread);

// The columns NAME of the median, and NAME with these endings of the quartiles. The number of rounds has no column
// here.
struct QuartileEndings {
    std::string lower = "_low", upper = "_high";
};
analysis::Columns<Spread> spread_columns(const std::string& name, const QuartileEndings& endings = {});

// Processor time of the calling thread for this work [s].
template <typename Work>
double cpu_seconds(const Work& work)
{
    const double start = thread_cpu_s();
    work();
    return thread_cpu_s() - start;
}

// A scene that runs in a process of its own, so that its peak memory, its loaded libraries and its breakdowns are its
// own.
//   const nlohmann::json run = run_scene_alone(scene, folder);
//   run.at("cost").at("peak_memory_mb")

// The run.json of the run in `folder`. The new process calls `prepare` first. Errors as in_own_process and run_scene.
nlohmann::json run_scene_alone(const Scene& scene, const std::string& folder,
                               const std::function<void()>& prepare = {});

}  // namespace experiments
