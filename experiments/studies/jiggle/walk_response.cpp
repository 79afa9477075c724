#include "experiments/studies/jiggle/walk_response.hpp"

#include "experiments/process/terminal.hpp"
#include "pbs/solver/options.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace experiments {
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

}  // namespace experiments
