#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/jiggle/jiggle_reference.hpp"

#include <cmath>

namespace experiments {
namespace {

JoltResponse at_frequency(const pbs::Character& character, const DeformerSpec& fem, const std::vector<int>& probe, Jolt jolt,
                          double frequency_hz)
{
    jolt.time_step_s = 1.0 / (reference_steps_a_period * frequency_hz);
    jolt.steps = reference_steps_a_period * reference_periods;
    return jolt_response(character, fem, probe, jolt);
}

}  // namespace

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
    options.model = reference_fem::Model::stable_neo_hookean;
    options.element_order = 1;
    options.dynamics = reference_fem::Dynamics::generalized_alpha;
    options.young_pa = young_pa;
    return spec;
}

}  // namespace experiments
