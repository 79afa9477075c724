// Cost of one step at 24 iterations beside the blends, on the built-in limb: what the real-time claim asks for. Read ratios from one run;
// absolute times are the machine's of that moment.
//   build/release/tests/benchmark_step
#include "pbs/character/bodies.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace pbs;

struct BentLimb {
    Character character = make_character({.body = "limb"});
    Pose pose = joint_sweep(character.skeleton, 1, Vec3::UnitZ(), 60.0, 2, 0.01).steps[1];
    Positions bind_points = posed_bind_points(character.binding, pose);
};

const BentLimb& bent_limb()
{
    static const BentLimb limb;
    return limb;
}

void lbs(benchmark::State& state)
{
    Positions posed;
    for (auto _ : state) linear_blend_skinning(bent_limb().character.mesh.rest, bent_limb().character.weights, bent_limb().pose, posed);
}

void dqs(benchmark::State& state)
{
    Positions posed;
    for (auto _ : state) dual_quaternion_skinning(bent_limb().character.mesh.rest, bent_limb().character.weights, bent_limb().pose, posed);
}

void step(benchmark::State& state, Precision precision)
{
    const BentLimb& limb = bent_limb();
    PbsOptions options;
    options.precision = precision;
    PbsSolver solver(limb.character.mesh, limb.character.binding.distance, {}, options);
    Positions posed;
    linear_blend_skinning(limb.character.mesh.rest, limb.character.weights, limb.pose, posed);
    for (auto _ : state) solver.advance(posed, limb.bind_points, 0.01);
}

BENCHMARK(lbs)->Unit(benchmark::kMillisecond);
BENCHMARK(dqs)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, plain_f32, Precision::f32)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, plain_f64, Precision::f64)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
