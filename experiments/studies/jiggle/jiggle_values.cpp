#include "experiments/studies/jiggle/jiggle_values.hpp"

#include "analysis/statistics/statistics.hpp"

#include <algorithm>

namespace experiments {
namespace {

constexpr int least_for_correlation = 4;

using analysis::Interval;
using analysis::Measurement;

Measurement measurement(const std::string& quantity, const analysis::CaseKey& of, const Interval& value, const std::string& unit)
{
    return {"C09", quantity, of, value.estimate, value.low, value.high, unit};
}

Measurement exact_value(const std::string& quantity, const analysis::CaseKey& of, double value)
{
    return {"C09", quantity, of, value, value, value, "1"};
}

Interval over(const Interval& a, const Interval& b)
{
    return {a.estimate / b.estimate, a.low / b.high, a.high / b.low};
}

const Interval* frequency_at(const std::vector<MeasuredJiggle>& measured, const JiggleSetting& setting)
{
    const auto found = std::find_if(measured.begin(), measured.end(), [&](const auto& one) { return one.setting == setting; });
    return found != measured.end() && found->response.swing.found() ? &found->response.swing.frequency_hz : nullptr;
}

struct FrequencyRatio {
    JiggleSetting from;
    Interval ratio;
};

// The ratio of the frequency at each setting to the frequency at the setting from which it is changed.
std::vector<FrequencyRatio> ratios(const std::vector<MeasuredJiggle>& measured, void (*change)(JiggleSetting&))
{
    std::vector<FrequencyRatio> all;
    for (const MeasuredJiggle& one : measured) {
        JiggleSetting changed = one.setting;
        change(changed);
        const Interval *at = frequency_at(measured, one.setting), *there = frequency_at(measured, changed);
        if (at && there) all.push_back({one.setting, over(*there, *at)});
    }
    return all;
}

void add_share(std::vector<Measurement>& measurements, const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    int all = 0, swinging = 0;
    for (const MeasuredJiggle& one : measured) {
        if (!is_of_the_paper(one.setting)) continue;
        ++all;
        swinging += one.response.swing.found();
    }
    if (all == 0) return;
    measurements.push_back(exact_value("share_of_settings_that_swing", {.body = body}, static_cast<double>(swinging) / all));
    measurements.back().n = all;
}

void add_setting(std::vector<Measurement>& measurements, const std::string& body, const MeasuredJiggle& one)
{
    const analysis::CaseKey of = key_of(body, one.setting);
    if (one.response.finished) measurements.push_back(exact_value("amplitude", of, one.response.overshoot_over_jolt));
    if (!one.response.swing.found()) return;
    const std::string damping = is_of_the_paper(one.setting) ? "damping_ratio" : "damping_ratio_in_other_readings";
    measurements.push_back(measurement(damping, of, one.response.swing.damping_ratio, "1"));
    measurements.push_back(measurement("frequency_hz", of, one.response.swing.frequency_hz, "Hz"));
}

// Those that swing and differ from the first setting in k_stretch alone, the smallest first.
std::vector<MeasuredJiggle> by_k_stretch(const std::vector<MeasuredJiggle>& measured)
{
    std::vector<MeasuredJiggle> chosen;
    for (const MeasuredJiggle& one : measured)
        if (one.response.swing.found() && one.setting == JiggleSetting{.k_stretch = one.setting.k_stretch}) chosen.push_back(one);
    std::stable_sort(chosen.begin(), chosen.end(), [](auto& a, auto& b) { return a.setting.k_stretch < b.setting.k_stretch; });
    return chosen;
}

double correlation_without(const std::vector<MeasuredJiggle>& measured, std::size_t left_out)
{
    std::vector<double> k, hz;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        if (i == left_out) continue;
        k.push_back(measured[i].setting.k_stretch);
        hz.push_back(measured[i].response.swing.frequency_hz.estimate);
    }
    return std::clamp(analysis::rank_correlation(k, hz), -1.0, 1.0);  // rounding goes beyond
}

void add_correlation(std::vector<Measurement>& measurements, const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    if (static_cast<int>(measured.size()) < least_for_correlation) return;
    Measurement correlation =
        exact_value("rank_correlation_of_frequency_and_k_stretch", {.body = body}, correlation_without(measured, measured.size()));
    correlation.n = static_cast<int>(measured.size());
    for (std::size_t left_out = 0; left_out < measured.size(); ++left_out) {
        const double without = correlation_without(measured, left_out);
        correlation.low = std::min(correlation.low, without);
        correlation.high = std::max(correlation.high, without);
    }
    measurements.push_back(correlation);
}

void add_range(std::vector<Measurement>& measurements, const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    if (measured.size() < 2) return;
    const MeasuredJiggle &smallest = measured.front(), &largest = measured.back();
    const analysis::CaseKey of = {.body = body, .k_stretch = smallest.setting.k_stretch, .k_stretch_to = largest.setting.k_stretch};
    measurements.push_back(measurement("frequency_ratio_over_k_stretch", of,
                                       over(largest.response.swing.frequency_hz, smallest.response.swing.frequency_hz), "1"));
}

void add_half_step(std::vector<Measurement>& measurements, const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    const std::vector<FrequencyRatio> halvings = ratios(measured, [](JiggleSetting& setting) { setting.time_step_s /= 2.0; });
    if (halvings.empty()) return;
    Measurement half =
        exact_value("frequency_ratio_at_half_time_step", key_of(body, halvings.front().from), halvings.front().ratio.estimate);
    for (const FrequencyRatio& halving : halvings) {
        half.low = std::min(half.low, halving.ratio.estimate);
        half.high = std::max(half.high, halving.ratio.estimate);
    }
    half.n = static_cast<int>(halvings.size());
    measurements.push_back(half);
}

}  // namespace

std::vector<Measurement> jiggle_values(const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    std::vector<Measurement> measurements;
    add_share(measurements, body, measured);
    for (const MeasuredJiggle& one : measured) add_setting(measurements, body, one);
    add_correlation(measurements, body, by_k_stretch(measured));
    add_range(measurements, body, by_k_stretch(measured));
    add_half_step(measurements, body, measured);
    const std::vector<FrequencyRatio> doublings = ratios(measured, [](JiggleSetting& setting) { setting.iterations *= 2; });
    for (const auto& [from, ratio] : doublings)
        measurements.push_back(measurement("frequency_ratio_at_twice_iterations", key_of(body, from), ratio, "1"));
    return measurements;
}

}  // namespace experiments
