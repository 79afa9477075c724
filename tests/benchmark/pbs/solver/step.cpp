// One step of 24 iterations in each order and precision, on bars of about 2,200 and 19,500 vertices twisted by 90 degrees. Ratios of one
// run are meaningful; absolute times depend on the machine and its state. `pbskin bench` compares more cases, in turn.
//   build/release/tests/benchmark_step --benchmark_filter=ordered
#include "experiments/studies/timing/bench.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <benchmark/benchmark.h>

#include <map>

namespace {

using experiments::BenchBody;

const BenchBody& bar(int vertices)
{
    static std::map<int, BenchBody> bars;
    const auto found = bars.find(vertices);
    return found != bars.end() ? found->second : bars.emplace(vertices, experiments::bench_bar(vertices)).first->second;
}

void step(benchmark::State& state, pbs::Order order, pbs::Precision precision)
{
    const BenchBody& body = bar(static_cast<int>(state.range(0)));
    pbs::PbsOptions options;
    options.order = order;
    options.precision = precision;
    pbs::PbsSolver solver(body.mesh(), body.character.binding.distance, {}, options, body.held);
    for (auto _ : state) solver.advance(body.twisted, body.bind_points, 0.01);
    const double constraints = double(body.mesh().rest.rows() + body.edges + body.mesh().tets.rows());
    using benchmark::Counter;  // seconds per constraint, which the console prints as e.g. 0.9n
    state.counters["s_per_constraint"] = Counter(constraints * options.iterations, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void on_both_bars(benchmark::internal::Benchmark* of)
{
    of->Arg(2200)->Arg(19500)->ArgName("vertices")->Unit(benchmark::kMillisecond);
}

using pbs::Order;
using pbs::Precision;
BENCHMARK_CAPTURE(step, plain_f32, Order::plain, Precision::f32)->Apply(on_both_bars);
BENCHMARK_CAPTURE(step, ordered_f32, Order::ordered, Precision::f32)->Apply(on_both_bars);
BENCHMARK_CAPTURE(step, grouped_f32, Order::grouped, Precision::f32)->Apply(on_both_bars);
BENCHMARK_CAPTURE(step, plain_f64, Order::plain, Precision::f64)->Apply(on_both_bars);
BENCHMARK_CAPTURE(step, ordered_f64, Order::ordered, Precision::f64)->Apply(on_both_bars);
BENCHMARK_CAPTURE(step, grouped_f64, Order::grouped, Precision::f64)->Apply(on_both_bars);

}  // namespace

BENCHMARK_MAIN();
