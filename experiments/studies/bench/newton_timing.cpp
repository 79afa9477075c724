#include "experiments/studies/bench/newton_timing.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"

#include <algorithm>

namespace experiments {

NewtonTiming time_newton(const BenchBody& body, const Rounds& rounds)
{
    DeformerSpec spec = default_spec("fem");
    auto& options = options_of<FemOptions>(spec);
    options.element_order = 1;
    options.model = reference_fem::Model::stable_neo_hookean;
    pbs::StepSummary last;
    const TimedVariant frame = [&] {
        const std::unique_ptr<Deformer> fem = make_deformer(spec);
        fem->reset(body.character);
        fem->advance(pbs::Pose(body.pose.size(), Eigen::Isometry3d::Identity()), 0.01);  // at rest: analyses the pattern of the matrix
        return std::vector{cpu_seconds([&] { last = fem->advance(body.pose, 0.01); })};
    };
    const Spread seconds = spread_of(take_turns({frame}, rounds)[0][0]);
    NewtonTiming timing;
    timing.model = name_of(options.model);
    timing.steps = last.iterations;
    timing.ms_frame = scaled(seconds, 1e3);
    const double steps = std::max(1, last.iterations);
    timing.ms_step = scaled(seconds, 1e3 / steps);
    timing.ns_element = scaled(seconds, 1e9 / (steps * double(body.mesh().tets.rows())));
    timing.is_reached = last.outcome == pbs::Outcome::finished;
    return timing;
}

}  // namespace experiments
