#include "experiments/studies/bench/projection_timing.hpp"

#include "pbs/geometry/cost.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

// The values of one timed step [s], in this order.
enum Sample { stretch_s, volume_s, bind_s, step_s, step_wall_s, transfer_s, samples };

double wall_s()
{
    static const pbs::Stopwatch since_start;
    return since_start.seconds();
}

// Adds the laps of a step to the sum of their class. Short steps are lapped by wall time, which takes some 25 ns to read. Long steps, in
// which other work is sure to get its turns, are lapped by processor time, which takes some ten times longer to read.
void project_step(const StepLoops& loops, double (*lap_clock)(), std::vector<double>& seconds)
{
    double before = lap_clock();
    const auto lap = [&](Sample of) {
        const double now = lap_clock();
        seconds[of] += now - before;
        before = now;
    };
    for (int iteration = 0; iteration < iterations_per_step; ++iteration) {
        loops.bind(), lap(bind_s);
        loops.stretch(), lap(stretch_s);
        loops.volume(), lap(volume_s);
    }
}

std::vector<double> time_step(const ProjectionVariant& variant)
{
    constexpr double long_step_s = 2e-3;
    const StepLoops& loops = variant.loops;
    loops.load();
    const double warm_up = wall_s();  // brings the data into the caches after another variant's turn
    loops.bind(), loops.stretch(), loops.volume();
    const bool by_cpu = variant.threads == 1 && (wall_s() - warm_up) * iterations_per_step > long_step_s;

    std::vector<double> seconds(samples, 0.0);
    const double load = wall_s();
    loops.load();
    const double cpu = thread_cpu_s(), wall = wall_s();
    project_step(loops, by_cpu ? thread_cpu_s : wall_s, seconds);
    const double cpu_end = thread_cpu_s(), wall_end = wall_s();
    loops.store();
    seconds[transfer_s] = wall - load + wall_s() - wall_end;
    seconds[step_wall_s] = wall_end - wall;
    seconds[step_s] = variant.threads == 1 ? cpu_end - cpu : wall_end - wall;
    const double laps = seconds[stretch_s] + seconds[volume_s] + seconds[bind_s];
    for (const Sample of : {stretch_s, volume_s, bind_s}) seconds[of] *= seconds[step_s] / laps;
    return seconds;
}

ProjectionTiming summed_up(const ProjectionVariant& variant, const Samples& own, const pbs::BodySize& size, const MachineLimits& limits)
{
    const pbs::ProjectionLayout layout{variant.scalar_bytes(), variant.poses};
    ProjectionTiming timing;
    static_cast<ProjectionKind&>(timing) = variant;
    timing.poses = variant.poses;
    timing.working_set_bytes = pbs::working_set_bytes(layout, size);
    const double gb_s = bandwidth_at(limits, timing.working_set_bytes);
    const auto ns_of = [&](pbs::ConstraintClass of, Sample sample) {
        return scaled(spread_of(own[sample]), 1e9 / (iterations_per_step * variant.poses * size.constraints(of)));
    };
    timing.stretch = ns_of(pbs::ConstraintClass::stretch, stretch_s);
    timing.volume = ns_of(pbs::ConstraintClass::volume, volume_s);
    timing.bind = ns_of(pbs::ConstraintClass::bind, bind_s);
    timing.ms_step = scaled(spread_of(own[step_s]), 1e3 / variant.poses);
    timing.ms_transfer = scaled(spread_of(own[transfer_s]), 1e3 / variant.poses).median;
    const double step_bytes = iterations_per_step * pbs::bytes_per_iteration(layout, size) / variant.poses;
    if (variant.threads == 1) timing.ms_floor = 1e3 * step_bytes / (1e9 * gb_s);
    timing.stretch_fill = variant.stretch_fill;
    timing.volume_fill = variant.volume_fill;
    timing.residuals = variant.loops.residuals();
    return timing;
}

double combined(const pbs::Residuals& residuals, double mean_distance_m)
{
    const double bind = residuals.bind_rms_m / mean_distance_m;
    return std::sqrt((residuals.stretch_rms * residuals.stretch_rms + residuals.volume_rms * residuals.volume_rms + bind * bind) / 3.0);
}

}  // namespace

AnswerRatio answer_ratio(const pbs::Residuals& own, const pbs::Residuals& plain, double mean_distance_m)
{
    return {combined(own, mean_distance_m) / combined(plain, mean_distance_m), own.volume_rms / plain.volume_rms};
}

std::vector<ProjectionTiming> time_projections(const BenchBody& body, const std::vector<int>& threads, const MachineLimits& limits,
                                               const Rounds& rounds)
{
    const std::vector<ProjectionVariant> variants = projection_variants(body, threads);
    std::vector<TimedVariant> turns;
    for (const ProjectionVariant& variant : variants) turns.push_back([&variant] { return time_step(variant); });
    const std::vector<Samples> all = take_turns(turns, rounds);
    // std::out_of_range where there is no such variant.
    const auto index_of = [&](const ProjectionKind& kind) {
        return std::find_if(variants.begin(), variants.end(), [&](const ProjectionKind& one) { return one == kind; }) - variants.begin();
    };

    const pbs::BodySize size{double(body.mesh().rest.rows()), double(body.edges), double(body.mesh().tets.rows())};
    const double mean_distance_m = body.character.binding.distance.mean();
    std::vector<ProjectionTiming> timings;
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const ProjectionVariant& variant = variants[i];
        ProjectionTiming timing = summed_up(variant, all[i], size, limits);
        const Sample clock = variant.threads == 1 ? step_s : step_wall_s;
        const auto ratio_to = [&](const std::string& name) {
            return spread_of_ratios(all.at(index_of({name, variant.precision, 1}))[clock], all[i][clock], variant.poses);
        };
        timing.ratio_to_plain = ratio_to("plain");
        timing.ratio_to_plain_native = ratio_to("plain_native");
        timing.ratio_to_plain_spread = ratio_to("plain_spread");
        const auto answer_to = [&](const std::string& name) {
            return answer_ratio(timing.residuals, variants.at(index_of({name, variant.precision, 1})).loops.residuals(), mean_distance_m);
        };
        timing.answer_to_plain = answer_to("plain");
        timing.answer_to_plain_spread = answer_to("plain_spread");
        if (variant.threads > 1) {
            const auto alone = index_of({variant.variant, variant.precision, 1});
            const std::vector<double>&alone_s = all.at(alone)[step_wall_s], &together_s = all[i][step_wall_s];
            const double times_the_poses = double(variant.poses) / variants[alone].poses;
            timing.speedup_by_threads = spread_of_ratios(alone_s, together_s, times_the_poses);
            timing.best_speedup_by_threads = times_the_poses * *std::min_element(alone_s.begin(), alone_s.end()) /
                                             *std::min_element(together_s.begin(), together_s.end());
        }
        timings.push_back(std::move(timing));
    }
    return timings;
}

}  // namespace experiments
