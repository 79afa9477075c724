#include "experiments/studies/bench/mesh_timings.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace experiments {
namespace {

constexpr int most_fem_tets = 150'000;  // of the reference, whose first solve takes seconds there

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
