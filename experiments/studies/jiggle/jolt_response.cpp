#include "experiments/studies/jiggle/jolt_response.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/process/terminal.hpp"

#include <algorithm>
#include <cmath>

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
    return jolt_response(character, *make_deformer(spec), probe, jolt);
}

JoltResponse jolt_response(const pbs::Character& character, Deformer& deformer, const std::vector<int>& probe, const Jolt& jolt)
{
    deformer.reset(character);
    const pbs::Pose still = moved_by(character.skeleton.bones.size(), pbs::Vec3::Zero()),
                    moved = moved_by(character.skeleton.bones.size(), jolt.length_m * jolt.direction);
    const Eigen::Index vertices = character.mesh.rest.rows();
    JoltResponse response;
    const auto advance = [&](const pbs::Pose& pose) {
        stop_if_interrupted();
        response.finished = response.finished && deformer.advance(pose, jolt.time_step_s).outcome == pbs::Outcome::finished;
    };
    for (int step = 0; step < jolt.still_steps; ++step) advance(still);
    const pbs::Positions lay = deformer.positions().topRows(vertices);
    for (int step = 0; step < jolt.steps && response.finished; ++step) {
        const pbs::Positions before = deformer.positions().topRows(vertices);
        advance(moved);
        const pbs::Positions now = deformer.positions().topRows(vertices);
        double excursion_m = 0.0;
        for (const int v : probe) excursion_m += (now.row(v) - lay.row(v)).dot(jolt.direction) - jolt.length_m;
        response.excursion_m.push_back(excursion_m / static_cast<double>(probe.size()));
        response.speed_rms_m_s.push_back((now - before).norm() / std::sqrt(double(vertices)) / jolt.time_step_s);
    }
    sum_up(response, jolt);
    return response;
}

std::optional<JiggleReference> match_reference(const pbs::Character& character, DeformerSpec fem, const std::vector<int>& probe,
                                               const Jolt& jolt, double frequency_hz)
{
    const JoltResponse first = at_frequency(character, fem, probe, jolt, frequency_hz);
    if (!first.finished || !first.swing.found()) return std::nullopt;
    double& young_pa = options_of<FemOptions>(fem).young_pa;
    young_pa *= std::pow(frequency_hz / first.swing.frequency_hz.estimate, 2);
    JiggleReference matched{young_pa, 1.0 / (reference_steps_a_period * frequency_hz),
                            at_frequency(character, fem, probe, jolt, frequency_hz)};
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

}  // namespace experiments
