#include "experiments/studies/bench/mesh_timings.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace experiments {
namespace {

constexpr int most_fem_tets = 150'000;  // of the reference, whose first solve takes seconds there
constexpr int further_frames = 5;       // a sample

// First solve and one further frame [s].
std::vector<double> time_frames(const DeformerSpec& spec, const BenchBody& body)
{
    const std::unique_ptr<Deformer> fem = make_deformer(spec);
    const pbs::Pose rest(body.pose.size(), Eigen::Isometry3d::Identity());
    const double first = cpu_seconds([&] {
        fem->reset(body.character);
        fem->advance(body.pose, 0.01);
    });
    const double further = cpu_seconds([&] {
        for (int frame = 0; frame < further_frames; ++frame) fem->advance(frame % 2 == 0 ? rest : body.pose, 0.01);
    });
    return {first, further / further_frames};
}

// pbs::InputError where the build has no reference, or a bone of the body cannot be gripped.
FemTiming time_fem(const BenchBody& body, const Rounds& rounds)
{
    DeformerSpec spec = default_spec("fem");
    options_of<FemOptions>(spec).element_order = 1;
    const auto samples = take_turns({[&] { return time_frames(spec, body); }}, rounds);
    FemTiming timing;
    timing.ms_first_solve = scaled(spread_of(samples[0][0]), 1e3);
    timing.ms_further_frame = scaled(spread_of(samples[0][1]), 1e3);
    timing.further_to_first = timing.ms_further_frame.median / timing.ms_first_solve.median;
    return timing;
}

nlohmann::json fem_json(const FemTiming& timing, double plain_step_ms)
{
    nlohmann::json json = {{"variant", "fem"},
                           {"model", timing.model},
                           {"element_order", timing.element_order},
                           {"precision", "f64"},
                           {"threads", 1},
                           {"clock", "thread_cpu"},
                           {"further_to_first", timing.further_to_first},
                           {"ratio_to_plain", plain_step_ms / timing.ms_further_frame.median}};
    put_spread(json, "ms_first_solve", timing.ms_first_solve);
    put_spread(json, "ms_further_frame", timing.ms_further_frame);
    return json;
}

Rounds shorter(Rounds rounds)
{
    rounds.seconds /= 4.0;
    return rounds;
}

Rounds few(Rounds rounds)
{
    rounds.fewest = std::min(rounds.fewest, 2);
    rounds.most = std::min(rounds.most, 11);
    return rounds;
}

void step_once(const BenchBody& body)
{
    pbs::PbsSolver solver(body.mesh(), body.character.binding.distance, {}, {}, body.held);
    solver.advance(body.twisted, body.bind_points, 0.01);
}

void time_fem_or_say_why(const BenchBody& body, const Rounds& rounds, MeshTimings& timings)
{
    try {
        timings.fem = time_fem(body, rounds);
    } catch (const pbs::InputError& error) {
        timings.fem_left_out = error.what();
    }
}

double plain_f64_step_ms(const MeshTimings& timings)
{
    for (const ProjectionTiming& timing : timings.projections)
        if (timing.variant == "plain" && timing.precision == "f64") return timing.ms_step.median;
    return 0.0;
}

}  // namespace

MeshTimings time_mesh(const BenchBody& body, const MachineLimits& limits, const MeshTimingOptions& options)
{
    MeshTimings timings;
    timings.name = body.character.name;
    timings.vertices = static_cast<int>(body.mesh().rest.rows());
    timings.edges = body.edges;
    timings.tets = static_cast<int>(body.mesh().tets.rows());
    timings.memory = peak_memory_of([&] { step_once(body); });
    timings.projections = time_projections(body, options.threads, limits, options.rounds);
    timings.skinning = time_skinning(body, limits, shorter(options.rounds));
    if (options.fem && timings.tets <= most_fem_tets) time_fem_or_say_why(body, few(shorter(options.rounds)), timings);
    return timings;
}

nlohmann::json json_of(const MeshTimings& timings)
{
    nlohmann::json json = {
        {"mesh", {{"name", timings.name}, {"vertices", timings.vertices}, {"edges", timings.edges}, {"tets", timings.tets}}},
        {"results", nlohmann::json::array()},
        {"yardsticks", nlohmann::json::array()},
        {"skinning", timings.skinning},
        {"fem", nlohmann::json::array()},
        {"memory", {{"peak_bytes", timings.memory.peak_bytes}, {"growth_bytes", timings.memory.growth_bytes()}}}};
    for (const ProjectionTiming& timing : timings.projections) json[timing.is_yardstick() ? "yardsticks" : "results"].push_back(timing);
    if (timings.fem) json["fem"].push_back(fem_json(*timings.fem, plain_f64_step_ms(timings)));
    if (!timings.fem_left_out.empty()) json["fem_left_out"] = timings.fem_left_out;
    return json;
}

}  // namespace experiments
