#include "experiments/studies/stiffness/step_near_rest.hpp"

#include "experiments/studies/shared/near_rest/matrix_free.hpp"
#include "experiments/studies/shared/near_rest/stacked_rows.hpp"
#include "pbs/solver/constraint_set.hpp"

#include <unsupported/Eigen/IterativeSolvers>

#include <algorithm>
#include <random>

namespace experiments {
namespace {

using pbs::Positions;
using pbs::Vec3;

constexpr double tolerance = 1e-8;
constexpr int krylov_vectors = 400, most_iterations = 800;

template <typename Constraint>
void shuffle_if(unsigned long seed, std::vector<Constraint>& constraints)
{
    std::mt19937_64 random(seed);
    if (seed != 0) std::shuffle(constraints.begin(), constraints.end(), random);
}

std::array<Vec3, 1> rest_gradients(const LoadedFlesh& flesh, const pbs::BindConstraint<double>& bind)
{
    return {gradient<double>(bind, flesh.mesh.rest.row(bind.vertex), flesh.bind_point.row(bind.vertex))};
}

std::array<Vec3, 2> rest_gradients(const LoadedFlesh& flesh, const pbs::StretchConstraint<double>& edge)
{
    return gradient<double>(edge, flesh.mesh.rest.row(edge.vertex[0]), flesh.mesh.rest.row(edge.vertex[1]));
}

std::array<Vec3, 4> rest_gradients(const LoadedFlesh& flesh, const pbs::VolumeConstraint<double>& tet)
{
    const auto rest = [&](int corner) -> Vec3 { return flesh.mesh.rest.row(tet.vertex[corner]); };
    return gradient<double>(tet, rest(0), rest(1), rest(2), rest(3));
}

int vertex_of(const pbs::BindConstraint<double>& bind, std::size_t)
{
    return bind.vertex;
}

template <typename Constraint>
int vertex_of(const Constraint& constraint, std::size_t corner)
{
    return constraint.vertex[corner];
}

}  // namespace

StepNearRest::StepNearRest(const LoadedFlesh& flesh, const StiffnessSetting& setting)
    : iterations_(setting.method == Method::xpbd_small_steps ? 1 : setting.iterations),
      forgets_(setting.method == Method::xpbd_forgetting),
      step_s_(setting.method == Method::xpbd_small_steps ? setting.time_step_s / setting.iterations : setting.time_step_s)
{
    if (is_xpbd(setting.method))
        add_xpbd(flesh, setting);
    else
        add_pbs(flesh, setting);
}

void StepNearRest::add_pbs(const LoadedFlesh& flesh, const StiffnessSetting& setting)
{
    auto set = pbs::make_constraint_set<double>(flesh.mesh, bind_distance_of(flesh), flesh.zone, pbs_options(flesh, setting), flesh.held);
    const auto add_class = [&](auto& constraints) {
        shuffle_if(setting.order_seed, constraints);
        for (const auto& constraint : constraints) add_near_rest(flesh, constraint, constraint.stiffness, 0.0, set.inverse_mass);
    };
    add_class(set.bind), add_class(set.stretch), add_class(set.volume);
}

void StepNearRest::add_xpbd(const LoadedFlesh& flesh, const StiffnessSetting& setting)
{
    const XpbdSolver solver(flesh.mesh, flesh.bind_distance, flesh.zone, xpbd_options(flesh, setting), flesh.held);
    const auto add_class = [&](auto constraints) {
        shuffle_if(setting.order_seed, constraints);
        for (const auto& [constraint, compliance, multiplier] : constraints)
            add_near_rest(flesh, constraint, 1.0, compliance, solver.inverse_masses_1_kg());
    };
    add_class(solver.bind()), add_class(solver.stretch()), add_class(solver.volume());
}

// A vertex on its bone, d = 0, is drawn to its material point whichever way it moves.
template <typename Constraint>
void StepNearRest::add_near_rest(const LoadedFlesh& flesh, const Constraint& constraint, double share, double compliance,
                                 const std::vector<double>& inverse_mass)
{
    const auto gradients = rest_gradients(flesh, constraint);
    const bool is_bind = gradients.size() == 1;
    if (!is_bind || gradients[0].squaredNorm() > 0.0) return add(constraint, gradients, share, compliance, inverse_mass);
    for (int axis = 0; axis < 3; ++axis) add(constraint, std::array<Vec3, 1>{Vec3::Unit(axis)}, share, compliance, inverse_mass);
}

template <typename Constraint, std::size_t count>
void StepNearRest::add(const Constraint& constraint, const std::array<Vec3, count>& gradients, double share, double compliance,
                       const std::vector<double>& inverse_mass)
{
    Projection projection;
    projection.vertices = static_cast<int>(count);
    projection.share = share;
    projection.compliance_per_dt2 = compliance / (step_s_ * step_s_);
    projection.denominator = projection.compliance_per_dt2;
    double w_gradient2 = 0.0;
    std::fill(std::begin(projection.gradient), std::end(projection.gradient), Vec3::Zero());
    std::fill(std::begin(projection.moved), std::end(projection.moved), Vec3::Zero());
    for (std::size_t i = 0; i < count; ++i) {
        projection.vertex[i] = vertex_of(constraint, i);
        const double w = inverse_mass[projection.vertex[i]];
        projection.gradient[i] = gradients[i];
        projection.moved[i] = w * gradients[i];
        w_gradient2 += w * gradients[i].squaredNorm();
    }
    projection.denominator += w_gradient2;
    if (w_gradient2 > 0.0) projections_.push_back(projection);
}

void StepNearRest::forget_multipliers()
{
    for (Projection& projection : projections_) projection.multiplier = 0.0;
}

void StepNearRest::apply(Positions& displacement)
{
    for (int iteration = 0; iteration < iterations_; ++iteration) {
        if (iteration == 0 || forgets_) forget_multipliers();
        for (Projection& projection : projections_) {
            double C = 0.0;
            for (int i = 0; i < projection.vertices; ++i) C += displacement.row(projection.vertex[i]).dot(projection.gradient[i]);
            const double change = -projection.share * (C + projection.compliance_per_dt2 * projection.multiplier) / projection.denominator;
            projection.multiplier += change;
            for (int i = 0; i < projection.vertices; ++i)
                displacement.row(projection.vertex[i]) += change * projection.moved[i].transpose();
        }
    }
}

RestingFlesh rest_near_rest(const LoadedFlesh& flesh, const StiffnessSetting& setting)
{
    StepNearRest step(flesh, setting);
    const StackedRows zone(flesh.zone);
    RestingFlesh rest;
    const auto of_step = [&](const Eigen::VectorXd& x) {
        ++rest.steps;
        Positions displacement = zone.at_vertices(x);
        step.apply(displacement);
        return displacement;
    };
    const auto S = [&](const Eigen::VectorXd& x) { return zone.stacked(of_step(x)); };
    const MatrixFree identity_minus_S(zone.size(), [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return x - S(x); });
    Eigen::GMRES<MatrixFree, Eigen::IdentityPreconditioner> gmres;
    gmres.set_restart(krylov_vectors);
    gmres.setMaxIterations(most_iterations);
    gmres.setTolerance(tolerance);
    gmres.compute(identity_minus_S);
    const Eigen::VectorXd moved = step.step_s() * step.step_s() * flesh.direction.replicate(zone.size() / 3, 1);  // under 1 m/s^2
    const Eigen::VectorXd right_hand_side = S(moved);
    const Eigen::VectorXd x = gmres.solve(right_hand_side);
    rest.residual = (x - S(x) - right_hand_side).norm() / right_hand_side.norm();
    rest.converged = rest.residual <= 10.0 * tolerance;
    rest.displacement = of_step(x + moved);
    return rest;
}

}  // namespace experiments
