#include "reference_fem/dynamics/vibrating_body.hpp"

#include "reference_fem/linear_solvers.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <random>

namespace reference_fem {
namespace {

constexpr int block_size = 8;  // the error falls by omega_1^2 / omega_9^2 an iteration
constexpr int most_iterations = 100;
constexpr double shape_tolerance = 1e-13;

Eigen::MatrixXd random_block(const std::vector<bool>& prescribed)
{
    const auto free = std::count(prescribed.begin(), prescribed.end(), false);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    Eigen::MatrixXd block(prescribed.size(), std::min<Eigen::Index>(block_size, free));
    for (Eigen::Index i = 0; i < block.rows(); ++i)
        for (Eigen::Index k = 0; k < block.cols(); ++k) block(i, k) = prescribed[i] ? 0.0 : entry(random);
    return block;
}

Eigen::VectorXd scaled(const Eigen::VectorXd& shape)
{
    Eigen::Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    return shape / shape(largest);
}

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

Mode first_mode(const SparseMatrix& stiffness, const ConsistentMass& mass, const std::vector<bool>& prescribed,
                LinearSolver solver)
{
    Eigen::MatrixXd block = random_block(prescribed), with_mass(block.rows(), block.cols());
    Mode mode{std::numeric_limits<double>::quiet_NaN(), Eigen::VectorXd::Zero(block.rows())};
    if (block.cols() == 0) return mode;
    const EliminatedSystem system(stiffness, prescribed, solver);
    if (!system.usable()) return mode;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(block.rows());
    for (int k = 0; k < most_iterations; ++k) {
        for (Eigen::Index i = 0; i < block.cols(); ++i)
            block.col(i) = system.solve(mass.times(block.col(i)), zero).displacement;
        for (Eigen::Index i = 0; i < block.cols(); ++i) with_mass.col(i) = mass.times(block.col(i));
        // Ritz vectors: the modes of the body that may move in the block only.
        const Eigen::MatrixXd reduced_stiffness = block.transpose() * (stiffness * block),
                              reduced_mass = block.transpose() * with_mass;
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(reduced_stiffness, reduced_mass);
        block = (block * ritz.eigenvectors()).eval();
        const Eigen::VectorXd before = mode.shape;
        mode = {std::sqrt(ritz.eigenvalues()(0)), scaled(block.col(0))};
        if ((mode.shape - before).norm() < shape_tolerance * mode.shape.norm()) break;
    }
    return mode;
}

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

bool VibratingBody::run(TimeStepper& stepper, double step_s, int steps,
                        const std::function<void(int)>& after_step) const
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
