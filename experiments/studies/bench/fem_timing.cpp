#include "experiments/studies/bench/fem_timing.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/process/cpu_clock.hpp"
#include "experiments/studies/bench/timing_json.hpp"
#include "experiments/deformers/registry.hpp"

namespace experiments {
namespace {

constexpr int further_frames = 5;  // a sample

template <typename Work>
double cpu_seconds(const Work& work)
{
    const double start = thread_cpu_s();
    work();
    return thread_cpu_s() - start;
}

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

}  // namespace

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

}  // namespace experiments
