#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "pbs/solver/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace experiments {
namespace {

pbs::Pose moved_by(std::size_t bones, const pbs::Vec3& translation)
{
    pbs::Pose pose(bones, Eigen::Isometry3d::Identity());
    for (auto& bone : pose) bone.translation() = translation;
    return pose;
}

double largest(std::vector<double>::const_iterator first, std::vector<double>::const_iterator last)
{
    double most = 0.0;
    for (; first != last; ++first) most = std::max(most, std::abs(*first));
    return most;
}

double ratio(double a, double b)
{
    return b > 0.0 ? a / b : 0.0;
}

void sum_up(JoltResponse& response, const Jolt& jolt)
{
    const auto& excursion = response.excursion_m;
    const auto& speed = response.speed_rms_m_s;
    if (excursion.empty()) return;
    const auto tenth = static_cast<std::ptrdiff_t>(excursion.size() / 10);
    const double peak = largest(excursion.begin(), excursion.end());
    response.peak_over_jolt = peak / jolt.length_m;
    response.overshoot_over_jolt = std::max(*std::max_element(excursion.begin(), excursion.end()), 0.0) / jolt.length_m;
    response.left_over_peak = ratio(largest(excursion.end() - tenth, excursion.end()), peak);
    response.speed_growth = ratio(largest(speed.begin() + tenth, speed.end()), largest(speed.begin(), speed.begin() + tenth));
    response.swing = analysis::fit_damped_oscillation(excursion, jolt.time_step_s);
}

JoltResponse at_frequency(const pbs::Character& character, const DeformerSpec& fem, const std::vector<int>& probe, Jolt jolt,
                          double frequency_hz)
{
    jolt.time_step_s = 1.0 / (reference_steps_a_period * frequency_hz);
    jolt.steps = reference_steps_a_period * reference_periods;
    return jolt_response(character, fem, probe, jolt);
}

}  // namespace

JoltResponse jolt_response(const pbs::Character& character, const DeformerSpec& spec, const std::vector<int>& probe, const Jolt& jolt)
{
    const std::unique_ptr<Deformer> deformer = make_deformer(spec);
    deformer->reset(character);
    const pbs::Pose still = moved_by(character.skeleton.bones.size(), pbs::Vec3::Zero()),
                    moved = moved_by(character.skeleton.bones.size(), jolt.length_m * jolt.direction);
    const Eigen::Index vertices = character.mesh.rest.rows();
    JoltResponse response;
    const auto advance = [&](const pbs::Pose& pose) {
        stop_if_interrupted();
        response.finished = response.finished && deformer->advance(pose, jolt.time_step_s).outcome == pbs::Outcome::finished;
    };
    for (int step = 0; step < jolt.still_steps; ++step) advance(still);
    const pbs::Positions lay = deformer->positions().topRows(vertices);
    for (int step = 0; step < jolt.steps && response.finished; ++step) {
        const pbs::Positions before = deformer->positions().topRows(vertices);
        advance(moved);
        const pbs::Positions now = deformer->positions().topRows(vertices);
        double excursion_m = 0.0;
        for (const int v : probe) excursion_m += (now.row(v) - lay.row(v)).dot(jolt.direction) - jolt.length_m;
        response.excursion_m.push_back(excursion_m / static_cast<double>(probe.size()));
        response.speed_rms_m_s.push_back((now - before).norm() / std::sqrt(double(vertices)) / jolt.time_step_s);
    }
    sum_up(response, jolt);
    return response;
}

std::optional<JiggleReference> match_reference(const pbs::Character& character, const DeformerSpec& fem, const std::vector<int>& probe,
                                               const Jolt& jolt, double frequency_hz)
{
    const JoltResponse first = at_frequency(character, fem, probe, jolt, frequency_hz);
    if (!first.finished || !first.swing.found()) return std::nullopt;
    DeformerSpec matching = fem;
    double& young_pa = options_of<FemOptions>(matching).young_pa;
    young_pa *= std::pow(frequency_hz / first.swing.frequency_hz.estimate, 2);
    JiggleReference matched{young_pa, 1.0 / (reference_steps_a_period * frequency_hz),
                            at_frequency(character, matching, probe, jolt, frequency_hz)};
    if (!matched.response.finished || !matched.response.swing.found()) return std::nullopt;
    return matched;
}

DeformerSpec dynamic_reference(double young_pa)
{
    DeformerSpec spec = default_spec("fem");
    auto& options = options_of<FemOptions>(spec);
    options.model = reference_fem::Model::neo_hookean;
    options.element_order = 1;
    options.dynamics = reference_fem::Dynamics::generalized_alpha;
    options.young_pa = young_pa;
    return spec;
}

namespace {

double rms_over(const std::vector<bool>& zone, const pbs::Positions& difference)
{
    double sum = 0.0, count = 0.0;
    for (Eigen::Index v = 0; v < difference.rows(); ++v)
        if (zone[v]) {
            sum += difference.row(v).squaredNorm();
            count += 1.0;
        }
    return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

double mean_of(std::vector<double>::const_iterator first, std::vector<double>::const_iterator last)
{
    return first == last ? 0.0 : std::accumulate(first, last, 0.0) / static_cast<double>(last - first);
}

void sum_up(WalkResponse& response, std::size_t moving, int still_steps)
{
    const auto& lag = response.lag_rms_m;
    const auto& speed = response.speed_rms_m_s;
    if (lag.size() < moving + static_cast<std::size_t>(still_steps)) return;
    const auto end = lag.begin() + static_cast<std::ptrdiff_t>(moving);
    response.moving_lag_mm = 1e3 * std::sqrt(std::inner_product(lag.begin(), end, lag.begin(), 0.0) / static_cast<double>(moving));
    response.most_lag_mm = 1e3 * *std::max_element(lag.begin(), end);
    const double in_motion = mean_of(speed.begin(), speed.begin() + static_cast<std::ptrdiff_t>(moving));
    const double at_last = mean_of(speed.end() - std::max(still_steps / 10, 1), speed.end());
    response.last_speed_share = in_motion > 0.0 ? at_last / in_motion : 0.0;
}

}  // namespace

WalkResponse walk_response(const pbs::Character& character, const pbs::Motion& motion, const DeformerSpec& spec,
                           const std::vector<bool>& zone, int still_steps)
{
    DeformerSpec without = spec;
    options_of<pbs::PbsOptions>(without).jiggle.reset();
    const std::unique_ptr<Deformer> jiggling = make_deformer(spec), stiff = make_deformer(without);
    jiggling->reset(character);
    stiff->reset(character);
    std::vector<pbs::Pose> poses = motion.steps;
    poses.insert(poses.end(), still_steps, motion.steps.back());
    WalkResponse response;
    pbs::Positions before = character.mesh.rest;
    for (const pbs::Pose& pose : poses) {
        stop_if_interrupted();
        response.finished = jiggling->advance(pose, motion.time_step_s).outcome == pbs::Outcome::finished;
        if (!response.finished) break;
        stiff->advance(pose, motion.time_step_s);
        response.lag_rms_m.push_back(rms_over(zone, jiggling->positions() - stiff->positions()));
        const bool first = response.lag_rms_m.size() == 1;
        response.speed_rms_m_s.push_back(first ? 0.0 : rms_over(zone, jiggling->positions() - before) / motion.time_step_s);
        before = jiggling->positions();
    }
    sum_up(response, motion.steps.size(), still_steps);
    return response;
}

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

bool is_of_the_paper(const JiggleSetting& setting)
{
    return setting.k_bind == JiggleSetting{}.k_bind && setting.masses == JiggleSetting{}.masses;
}

DeformerSpec jiggling(DeformerSpec pbs, const JiggleSetting& setting)
{
    auto& options = options_of<pbs::PbsOptions>(pbs);
    options.k_stretch = 1.0;
    options.jiggle = pbs::Jiggle{.k_stretch = setting.k_stretch, .k_bind = setting.k_bind};
    options.iterations = setting.iterations;
    options.masses = setting.masses;
    return pbs;
}

analysis::CaseKey key_of(const std::string& body, const JiggleSetting& setting)
{
    analysis::CaseKey key = {.body = body,
                             .k_stretch = setting.k_stretch,
                             .masses = name_of(setting.masses),
                             .iterations = setting.iterations,
                             .time_step_s = setting.time_step_s};
    if (setting.k_bind < 1.0) key.k_bind = setting.k_bind;
    return key;
}

std::string text_of(const JiggleSetting& setting)
{
    const std::string bind = setting.k_bind < 1.0 ? fmt::format(", k_bind {}", setting.k_bind) : "";
    return fmt::format("k_stretch {}, {} ms, {} iterations, {} masses", setting.k_stretch, 1e3 * setting.time_step_s, setting.iterations,
                       name_of(setting.masses)) +
           bind;
}

RECORD_SETTINGS(JiggleSetting, k_stretch, time_step_s, iterations, k_bind, masses)

}  // namespace experiments
