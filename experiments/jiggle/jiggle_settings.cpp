#include "experiments/jiggle/jiggle_settings.hpp"

#include "analysis/statistics.hpp"
#include "experiments/deformers/option_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

constexpr int least_for_correlation = 4;

using analysis::Interval;
using analysis::Measurement;

Measurement figure(const std::string& quantity, const std::string& of, const Interval& value, const std::string& unit)
{
    return {"C09", quantity, of, value.estimate, value.low, value.high, unit};
}

Interval over(const Interval& a, const Interval& b)
{
    return {a.estimate / b.estimate, a.low / b.high, a.high / b.low, a.level, a.n, 0};
}

const Interval* frequency_at(const std::vector<MeasuredJiggle>& measured, const JiggleSetting& setting)
{
    const auto found = std::find_if(measured.begin(), measured.end(), [&](const auto& one) { return one.setting == setting; });
    return found != measured.end() && found->response.swing.found() ? &found->response.swing.frequency_hz : nullptr;
}

// The frequency at each setting over that at the setting it is changed from.
void add_ratios(std::vector<Measurement>& figures, const std::string& body, const std::vector<MeasuredJiggle>& measured,
                const std::string& quantity, void (*change)(JiggleSetting&))
{
    for (const MeasuredJiggle& one : measured) {
        JiggleSetting changed = one.setting;
        change(changed);
        const Interval *at = frequency_at(measured, one.setting), *there = frequency_at(measured, changed);
        if (at && there) figures.push_back(figure(quantity, body + ", from " + text_of(one.setting), over(*there, *at), "1"));
    }
}

void add_correlation(std::vector<Measurement>& figures, const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    std::vector<double> k, hz;
    for (const MeasuredJiggle& one : measured) {
        JiggleSetting of_base = one.setting;
        of_base.k_stretch = JiggleSetting{}.k_stretch;
        if (!(of_base == JiggleSetting{}) || !one.response.swing.found()) continue;
        k.push_back(one.setting.k_stretch);
        hz.push_back(one.response.swing.frequency_hz.estimate);
    }
    if (static_cast<int>(k.size()) < least_for_correlation) return;
    Interval correlation{analysis::rank_correlation(k, hz), 1.0, -1.0, 0.95, static_cast<int>(k.size()), 0};
    for (std::size_t left_out = 0; left_out < k.size(); ++left_out) {
        std::vector<double> fewer_k = k, fewer_hz = hz;
        fewer_k.erase(fewer_k.begin() + static_cast<std::ptrdiff_t>(left_out));
        fewer_hz.erase(fewer_hz.begin() + static_cast<std::ptrdiff_t>(left_out));
        const double without = analysis::rank_correlation(fewer_k, fewer_hz);
        correlation.low = std::min(correlation.low, without);
        correlation.high = std::max(correlation.high, without);
    }
    figures.push_back(
        figure("rank correlation of frequency and k_stretch", fmt::format("{}, {} values of k_stretch", body, k.size()), correlation, "1"));
}

}  // namespace

std::vector<JiggleSetting> jiggle_settings()
{
    std::vector<JiggleSetting> settings = {{}};
    for (const double k : {0.05, 0.2, 0.35, 0.5, 0.7, 0.9, 1.0}) settings.push_back({.k_stretch = k});
    for (const double dt_s : {0.0025, 0.005, 0.02, 0.04}) settings.push_back({.time_step_s = dt_s});
    for (const int iterations : {6, 12, 48, 96}) settings.push_back({.iterations = iterations});
    settings.push_back({.k_bind = 0.0});
    settings.push_back({.masses = pbs::Masses::lumped});
    return settings;
}

DeformerSpec jiggling(DeformerSpec pbs, const JiggleSetting& setting)
{
    pbs.pbs.k_stretch = 1.0;
    pbs.pbs.jiggle = pbs::Jiggle{.k_stretch = setting.k_stretch, .k_bind = setting.k_bind};
    pbs.pbs.iterations = setting.iterations;
    pbs.pbs.masses = setting.masses;
    pbs.pbs.gravity_m_s2 = pbs::Vec3::Zero();
    return pbs;
}

std::string text_of(const JiggleSetting& setting)
{
    const std::string bind = setting.k_bind < 1.0 ? fmt::format(", k_bind {}", setting.k_bind) : "";
    return fmt::format("k_stretch {}, {} ms, {} iterations, {} masses", setting.k_stretch, 1e3 * setting.time_step_s, setting.iterations,
                       name_of(setting.masses)) +
           bind;
}

std::vector<Measurement> jiggle_figures(const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    std::vector<Measurement> figures;
    for (const MeasuredJiggle& one : measured) {
        if (!one.response.swing.found()) continue;
        const std::string of = body + ", " + text_of(one.setting);
        figures.push_back(figure("damping ratio", of, one.response.swing.damping_ratio, "1"));
        figures.push_back(figure("frequency", of, one.response.swing.frequency_hz, "Hz"));
    }
    add_correlation(figures, body, measured);
    add_ratios(figures, body, measured, "frequency at half the time step over at the whole",
               [](JiggleSetting& s) { s.time_step_s /= 2.0; });
    add_ratios(figures, body, measured, "frequency at twice the iterations over at the once", [](JiggleSetting& s) { s.iterations *= 2; });
    return figures;
}

}  // namespace experiments
