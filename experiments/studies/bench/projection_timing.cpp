#include "experiments/studies/bench/projection_timing.hpp"

#include "experiments/studies/bench/step_loops.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace experiments {
namespace {

// What one timed step measures [s], in this order.
enum Sample { stretch_s, volume_s, bind_s, step_s, step_wall_s, transfer_s, samples };

using OfRounds = std::vector<double>;
using Samples = std::vector<OfRounds>;  // [Sample][round]

double wall_s()
{
    static const pbs::Stopwatch since_start;
    return since_start.seconds();
}

// Laps of a step, each class of constraints to its own sum. Wall time is quick to read (some 25 ns), and what short steps are lapped by;
// long ones, in which other work is sure to get its turns, are lapped by processor time, some ten times slower to read.
void project_step(const StepLoops& loops, double (*lap_clock)(), std::vector<double>& seconds)
{
    double before = lap_clock();
    const auto lap = [&](Sample of) {
        const double now = lap_clock();
        seconds[of] += now - before;
        before = now;
    };
    for (int iteration = 0; iteration < iterations_a_step; ++iteration) {
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
    const double warm_up = wall_s();  // its data into the caches, after another variant's turn
    loops.bind(), loops.stretch(), loops.volume();
    const bool by_cpu = variant.threads == 1 && (wall_s() - warm_up) * iterations_a_step > long_step_s;

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

RooflinePoint roofline_point(const ProjectionTiming& timing, ConstraintClass of, double ns, const BodySize& size,
                             const MachineLimits& limits)
{
    const bool f32 = timing.precision == "f32";
    const double bytes = bytes_of(of, {f32 ? 4.0 : 8.0, timing.poses}, size);
    RooflinePoint point;
    point.flops_a_byte = flops_of(of) / bytes;
    point.gflops = flops_of(of) / ns;
    point.attainable_gflops =
        attainable_gflops(f32 ? limits.gflops_f32 : limits.gflops_f64, bandwidth_at(limits, timing.working_set_bytes), point.flops_a_byte);
    point.share_of_limit = point.gflops / point.attainable_gflops;
    return point;
}

double memory_floor_ms(const ProjectionTiming& timing, const Layout& layout, const BodySize& size, const MachineLimits& limits)
{
    const double bytes = iterations_a_step * bytes_an_iteration(layout, size) / timing.poses;
    return 1e3 * bytes / (1e9 * bandwidth_at(limits, timing.working_set_bytes));
}

ClassTiming class_timing(const ProjectionTiming& timing, ConstraintClass of, const OfRounds& seconds, const BodySize& size,
                         const MachineLimits& limits)
{
    ClassTiming result;
    result.ns = scaled(spread_of(seconds), 1e9 / (iterations_a_step * timing.poses * size.constraints(of)));
    if (timing.threads == 1) result.roofline = roofline_point(timing, of, result.ns.median, size, limits);
    return result;
}

// Of the variant, or -1.
int index_of(const std::vector<ProjectionVariant>& variants, const std::string& name, const std::string& precision, int threads)
{
    for (std::size_t i = 0; i < variants.size(); ++i)
        if (variants[i].variant == name && variants[i].precision == precision && variants[i].threads == threads) return static_cast<int>(i);
    return -1;
}

void compare_threads(const OfRounds& alone_s, const OfRounds& together_s, double times_the_poses, ProjectionTiming& timing)
{
    timing.speedup_by_threads = spread_of_ratios(alone_s, together_s, times_the_poses);
    timing.best_speedup_by_threads =
        times_the_poses * *std::min_element(alone_s.begin(), alone_s.end()) / *std::min_element(together_s.begin(), together_s.end());
}

ProjectionTiming summed_up(const ProjectionVariant& variant, const Samples& own, const BodySize& size, const MachineLimits& limits)
{
    ProjectionTiming timing;
    timing.variant = variant.variant;
    timing.precision = variant.precision;
    timing.threads = variant.threads;
    timing.poses = variant.poses;
    timing.working_set_bytes = working_set_bytes({variant.scalar_bytes(), variant.poses}, size);
    timing.stretch = class_timing(timing, ConstraintClass::stretch, own[stretch_s], size, limits);
    timing.volume = class_timing(timing, ConstraintClass::volume, own[volume_s], size, limits);
    timing.bind = class_timing(timing, ConstraintClass::bind, own[bind_s], size, limits);
    timing.ms_step = scaled(spread_of(own[step_s]), 1e3 / variant.poses);
    timing.ms_transfer = scaled(spread_of(own[transfer_s]), 1e3 / variant.poses).median;
    if (variant.threads == 1) timing.ms_floor = memory_floor_ms(timing, {variant.scalar_bytes(), variant.poses}, size, limits);
    timing.stretch_fill = variant.stretch_fill;
    timing.volume_fill = variant.volume_fill;
    timing.residuals = variant.loops.residuals();
    return timing;
}

nlohmann::json json_of(const RooflinePoint& point)
{
    return {{"flops_per_byte", point.flops_a_byte},
            {"gflops", point.gflops},
            {"attainable_gflops", point.attainable_gflops},
            {"share_of_limit", point.share_of_limit}};
}

void put_class(nlohmann::json& json, const std::string& name, const ClassTiming& timing)
{
    put_spread(json, "ns_" + name, timing.ns);
    if (timing.roofline) json["roofline"][name] = json_of(*timing.roofline);
}

}  // namespace

std::vector<ProjectionTiming> time_projections(const BenchBody& body, const std::vector<int>& threads, const MachineLimits& limits,
                                               const Rounds& rounds)
{
    const std::vector<ProjectionVariant> variants = projection_variants(body, threads);
    std::vector<TimedVariant> turns;
    for (const ProjectionVariant& variant : variants) turns.push_back([&variant] { return time_step(variant); });
    const std::vector<Samples> all = take_turns(turns, rounds);

    const BodySize size{double(body.mesh().rest.rows()), double(body.edges), double(body.mesh().tets.rows())};
    std::vector<ProjectionTiming> timings;
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const ProjectionVariant& variant = variants[i];
        ProjectionTiming timing = summed_up(variant, all[i], size, limits);
        const Sample clock = variant.threads == 1 ? step_s : step_wall_s;
        const auto against = [&](const std::string& name) {
            return spread_of_ratios(all.at(index_of(variants, name, variant.precision, 1))[clock], all[i][clock], variant.poses);
        };
        timing.ratio_to_plain = against("plain");
        timing.ratio_to_plain_native = against("plain_native");
        timing.ratio_to_plain_spread = against("plain_spread");
        if (const int alone = index_of(variants, variant.variant, variant.precision, 1); alone >= 0 && variant.threads > 1)
            compare_threads(all[alone][step_wall_s], all[i][step_wall_s], double(variant.poses) / variants[alone].poses, timing);
        timings.push_back(std::move(timing));
    }
    return timings;
}

void to_json(nlohmann::json& json, const ProjectionTiming& timing)
{
    json = {{"variant", timing.variant},
            {"precision", timing.precision},
            {"threads", timing.threads},
            {"poses", timing.poses},
            {"clock", timing.threads == 1 ? "thread_cpu" : "wall"},
            {"ms_transfer", timing.ms_transfer},
            {"working_set_bytes", timing.working_set_bytes}};
    put_class(json, "stretch", timing.stretch);
    put_class(json, "volume", timing.volume);
    put_class(json, "bind", timing.bind);
    put_spread(json, "ms_step", timing.ms_step);
    put_spread(json, "ratio_to_plain", timing.ratio_to_plain);
    put_spread(json, "ratio_to_plain_native", timing.ratio_to_plain_native);
    put_spread(json, "ratio_to_plain_spread", timing.ratio_to_plain_spread);
    if (timing.speedup_by_threads) put_spread(json, "speedup_by_threads", *timing.speedup_by_threads);
    if (timing.ms_floor) json["ms_floor"] = *timing.ms_floor;
    if (timing.best_speedup_by_threads) json["best_speedup_by_threads"] = *timing.best_speedup_by_threads;
    json["residuals"] = {{"stretch_rms", timing.residuals.stretch_rms},
                         {"volume_rms", timing.residuals.volume_rms},
                         {"bind_rms_m", timing.residuals.bind_rms_m}};
    if (timing.stretch_fill) json["fill"] = {{"stretch", *timing.stretch_fill}, {"volume", *timing.volume_fill}};
}

}  // namespace experiments
