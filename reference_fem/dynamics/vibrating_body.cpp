#include "reference_fem/dynamics/vibrating_body.hpp"

#include "reference_fem/potentials/elastic_potential.hpp"

namespace reference_fem {
namespace {

std::vector<bool> held_dofs(const SimplexSpace& space, const std::function<Held(const pbs::Vec3&)>& held)
{
    std::vector<bool> dofs(space.dofs(), false);
    for (int node = 0; held && node < space.nodes(); ++node) {
        const Held components = held(space.node_positions().row(node));
        dofs[3 * node] = components.x;
        dofs[3 * node + 1] = components.y;
        dofs[3 * node + 2] = components.z;
    }
    return dofs;
}

NodalMatrix linear_stiffness(const SimplexSpace& space, const VibratingOptions& options)
{
    const Lame lame = lame_parameters(options.young_pa, options.poisson);
    return rest_stiffness(space, ElasticPotential(space, Model::linear, lame, Formulation::displacement));
}

}  // namespace

VibratingBody::VibratingBody(const pbs::TetMesh& mesh, const VibratingOptions& options)
    : space_(mesh, options.element_order),
      fixed_(held_dofs(space_, options.held)),
      density_kg_m3_(options.density_kg_m3),
      stiffness_(linear_stiffness(space_, options)),
      flesh_(stiffness_),
      mass_(space_, options.density_kg_m3),
      newton_(space_, fixed_, LinearSolver::cholmod)
{
}

TimeStepper VibratingBody::stepper(TimeStepperOptions options)
{
    options.density_kg_m3 = density_kg_m3_;
    return {space_, fixed_, flesh_, options, newton_};
}

bool VibratingBody::run(TimeStepper& stepper, double step_s, int steps, const std::function<void(int)>& after_step) const
{
    Eigen::VectorXd guess = stepper.motion().displacement;
    for (int k = 1; k <= steps; ++k) {
        if (!stepper.advance({&flesh_}, {}, step_s, guess, {}, {}).converged()) return false;
        if (after_step) after_step(k);
    }
    return true;
}

double VibratingBody::energy_j(const TimeStepper& stepper) const
{
    return flesh_.value(stepper.motion().displacement) + stepper.kinetic_energy_j();
}

double VibratingBody::amplitude(const TimeStepper& stepper, const Mode& mode) const
{
    const Eigen::VectorXd weights = mass_.times(mode.shape);
    return weights.dot(stepper.motion().displacement) / weights.dot(mode.shape);
}

}  // namespace reference_fem
