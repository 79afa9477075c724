#include "experiments/studies/shared/timed_rounds.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/run/run.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "pbs/geometry/cost.hpp"

#include <nlohmann/json.hpp>

#include <stdexcept>

namespace experiments {

RECORD_SETTINGS(Rounds, seconds, fewest, most)

std::vector<Samples> take_turns(const std::vector<TimedVariant>& variants, const Rounds& rounds)
{
    std::vector<Samples> samples(variants.size());
    for (std::size_t i = 0; i < variants.size(); ++i) samples[i].resize(variants[i]().size());
    const pbs::Stopwatch stopwatch;
    for (int round = 0; round < rounds.most && (round < rounds.fewest || stopwatch.seconds() < rounds.seconds); ++round)
        for (std::size_t i = 0; i < variants.size(); ++i) {
            const std::vector<double> numbers = variants[i]();
            for (std::size_t k = 0; k < numbers.size(); ++k) samples[i].at(k).push_back(numbers[k]);
        }
    return samples;
}

Spread spread_of(const std::vector<double>& samples)
{
    return {analysis::median(samples), analysis::quantile(samples, 0.25), analysis::quantile(samples, 0.75),
            static_cast<int>(samples.size())};
}

Spread spread_of_ratios(const std::vector<double>& numerator, const std::vector<double>& denominator, double factor)
{
    if (numerator.empty() || numerator.size() != denominator.size())
        throw std::logic_error("ratios of two variants need the same number of rounds");
    std::vector<double> ratios;
    for (std::size_t round = 0; round < numerator.size(); ++round)
        ratios.push_back(factor * numerator[round] / denominator[round]);
    return spread_of(ratios);
}

Spread scaled(const Spread& spread, double factor)
{
    return {factor * spread.median, factor * spread.lower, factor * spread.upper, spread.rounds};
}

void put_spread(nlohmann::json& json, const std::string& name, const Spread& spread)
{
    json[name] = spread.median;
    json["quartiles"][name] = {spread.lower, spread.upper};
    json["rounds"] = spread.rounds;
}

analysis::Columns<Spread> spread_columns(const std::string& name, const QuartileEndings& endings)
{
    return {{name, &Spread::median}, {name + endings.lower, &Spread::lower}, {name + endings.upper, &Spread::upper}};
}

nlohmann::json run_scene_alone(const Scene& scene, const std::string& folder, const std::function<void()>& prepare)
{
    return in_own_process([&] {
        if (prepare) prepare();
        run_scene(scene, folder);
        return analysis::read_record(analysis::path_in(folder, "run.json"));
    });
}

}  // namespace experiments
