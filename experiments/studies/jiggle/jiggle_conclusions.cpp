#include "analysis/statistics/statistics.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"

#include <algorithm>
#include <ranges>

namespace experiments {
namespace {

using analysis::CaseKey;
using analysis::Interval;
using analysis::Measurement;

using Series = std::map<double, Measurement>;  // by k_stretch, or by Young's modulus

constexpr std::size_t least_for_correlation = 4;

bool is_of_the_papers_solver(const CaseKey& of)
{
    return of.order == "plain" && of.precision == "f64";
}

Interval interval_of(const Measurement& measurement)
{
    return {measurement.value, measurement.low, measurement.high};
}

Measurement conclusion(const std::string& quantity, const CaseKey& of, const Interval& value, std::size_t n = 0)
{
    return {"C09",      quantity, of, value.estimate,        value.low,
            value.high, "1",      "", analysis::Limit::none, static_cast<int>(n)};
}

// The ratio of the frequency where a field of the case is changed by a factor to the frequency of the case.
std::vector<Measurement> frequency_ratios(const std::vector<Measurement>& measured, const std::string& quantity,
                                          std::optional<double> CaseKey::*field, double factor)
{
    std::vector<Measurement> ratios;
    for (const Measurement& frequency : measured) {
        if (frequency.quantity != "frequency_hz" || !(frequency.of.*field)) continue;
        CaseKey changed = frequency.of;
        *(changed.*field) *= factor;
        if (const Measurement* there = analysis::find_measurement(measured, frequency.quantity, changed))
            ratios.push_back(
                conclusion(quantity, frequency.of, analysis::ratio(interval_of(*there), interval_of(frequency))));
    }
    return ratios;
}

void add_share(const std::vector<Measurement>& measured, std::vector<Measurement>& to)
{
    std::vector<double> swings;  // 1 where it does
    CaseKey of;
    for (const Measurement& left : measured) {
        if (left.quantity != "last_share_of_peak" || !is_of_the_papers_solver(left.of)) continue;
        swings.push_back(analysis::find_measurement(measured, "damping_ratio", left.of) != nullptr);
        of.body = left.of.body;
    }
    const double share = analysis::mean(swings);
    if (!swings.empty())
        to.push_back(conclusion("share_of_settings_that_swing", of, {share, share, share}, swings.size()));
}

void add_correlation(const std::string& quantity, const CaseKey& of, const Series& series, std::vector<Measurement>& to)
{
    std::vector<double> stiffness, values;
    for (const auto& [at, measurement] : series) {
        stiffness.push_back(at);
        values.push_back(measurement.value);
    }
    if (series.size() >= least_for_correlation)
        to.push_back(
            conclusion(quantity, of, analysis::rank_correlation_without_one(stiffness, values), series.size()));
}

// The ratio is NaN where nothing swings beyond its place at any stiffness.
void add_amplitudes(CaseKey of, const Series& series, std::vector<Measurement>& to)
{
    if (series.size() < 2) return;
    of.iterations.reset();
    of.time_step_s.reset();
    const auto [least, most] = std::ranges::minmax(series | std::views::values, {}, &Measurement::value);
    const double ratio = most.value / least.value;
    to.push_back(conclusion("amplitude_ratio_over_k_stretch", of, {ratio, ratio, ratio}));
    add_correlation("rank_correlation_of_amplitude_and_k_stretch", of, series, to);
}

void add_frequencies(CaseKey of, const Series& series, std::vector<Measurement>& to)
{
    if (series.size() < 2 || !is_of_the_papers_solver(of)) return;
    const auto& [softest, slowest] = *series.begin();
    const auto& [stiffest, fastest] = *series.rbegin();
    of = {.body = of.body};
    add_correlation("rank_correlation_of_frequency_and_k_stretch", of, series, to);
    of.k_stretch = softest;
    of.k_stretch_to = stiffest;
    to.push_back(
        conclusion("frequency_ratio_over_k_stretch", of, analysis::ratio(interval_of(fastest), interval_of(slowest))));
}

void add_half_step(const std::vector<Measurement>& measured, std::vector<Measurement>& to)
{
    const auto halvings = frequency_ratios(measured, "frequency_ratio_at_half_time_step", &CaseKey::time_step_s, 0.5);
    if (halvings.empty()) return;
    const auto [least, most] = std::ranges::minmax(halvings, {}, &Measurement::value);
    to.push_back(conclusion(halvings.front().quantity, halvings.front().of,
                            {halvings.front().value, least.value, most.value}, halvings.size()));
}

}  // namespace

std::vector<Measurement> jiggle_conclusions(const std::vector<Measurement>& measured)
{
    std::vector<Measurement> conclusions;
    add_share(measured, conclusions);
    for (const auto stiffness : {&CaseKey::k_stretch, &CaseKey::young_pa})
        for (const auto& [of, series] : series_over(measured, "amplitude", stiffness))
            add_amplitudes(of, series, conclusions);
    for (const auto& [of, series] : series_over(measured, "frequency_hz", &CaseKey::k_stretch))
        add_frequencies(of, series, conclusions);
    add_half_step(measured, conclusions);
    std::ranges::move(frequency_ratios(measured, "frequency_ratio_at_twice_iterations", &CaseKey::iterations, 2.0),
                      std::back_inserter(conclusions));
    return conclusions;
}

}  // namespace experiments
