#include "experiments/studies/shared/near_rest/settled_state.hpp"

#include "experiments/studies/shared/near_rest/matrix_free.hpp"
#include "experiments/studies/shared/near_rest/stacked_rows.hpp"

#include <unsupported/Eigen/IterativeSolvers>

namespace experiments {
namespace {

using pbs::Positions;
using pbs::Vec3;

constexpr double tolerance = 1e-8;
constexpr int krylov_vectors = 800, most_iterations = 1600;
constexpr double softest = 1e-9;  // nothing draws back what is moved by less than this share of it in a step

pbs::PbsOptions without_bind(pbs::PbsOptions options)
{
    options.k_bind = 0.0;
    options.jiggle.reset();
    return options;
}

std::vector<bool> free_of(std::vector<bool> held)
{
    held.flip();
    return held;
}

}  // namespace

IterationsNearRest::IterationsNearRest(const pbs::TetMesh& mesh, const std::vector<bool>& held, const pbs::PbsOptions& options)
    : iterations_(options.iterations)
{
    const auto constraints =
        pbs::make_constraint_set<double>(mesh, Eigen::VectorXd::Zero(mesh.rest.rows()), {}, without_bind(options), held);
    const auto rest = [&](int vertex) -> Vec3 { return mesh.rest.row(vertex); };
    for (const auto& edge : constraints.stretch)  // (12)
        add(edge, gradient(edge, rest(edge.vertex[0]), rest(edge.vertex[1])), constraints.inverse_mass);
    for (const auto& tet : constraints.volume)  // (13)
        add(tet, gradient(tet, rest(tet.vertex[0]), rest(tet.vertex[1]), rest(tet.vertex[2]), rest(tet.vertex[3])),
            constraints.inverse_mass);
}

// Eq. 8-9, weighted by inverse masses: p_i -= k C w_i g_i / sum w |g|^2.
template <typename Constraint, std::size_t count>
void IterationsNearRest::add(const Constraint& constraint, const std::array<Vec3, count>& gradients,
                             const std::vector<double>& inverse_mass)
{
    double denominator = 0.0;
    for (std::size_t i = 0; i < count; ++i) denominator += inverse_mass[constraint.vertex[i]] * gradients[i].squaredNorm();
    if (!(denominator > 0.0)) return;
    Projection projection;
    projection.vertices = static_cast<int>(count);
    for (std::size_t i = 0; i < count; ++i) {
        projection.vertex[i] = constraint.vertex[i];
        projection.gradient[i] = gradients[i];
        projection.correction[i] = constraint.stiffness * inverse_mass[constraint.vertex[i]] / denominator * gradients[i];
    }
    projections_.push_back(projection);
}

void IterationsNearRest::apply(Positions& displacement) const
{
    for (int iteration = 0; iteration < iterations_; ++iteration)
        for (const Projection& projection : projections_) {
            double C = 0.0;
            for (int i = 0; i < projection.vertices; ++i) C += displacement.row(projection.vertex[i]).dot(projection.gradient[i]);
            for (int i = 0; i < projection.vertices; ++i)
                displacement.row(projection.vertex[i]) -= C * projection.correction[i].transpose();
        }
}

SettledState settle(const pbs::TetMesh& mesh, const std::vector<bool>& held, const pbs::PbsOptions& options, const Vec3& acceleration_m_s2)
{
    const IterationsNearRest iterations(mesh, held, options);
    const StackedRows free(free_of(held));
    SettledState state;
    const auto S = [&](const Eigen::VectorXd& x) {
        ++state.steps;
        Positions displacement = free.at_vertices(x);
        iterations.apply(displacement);
        return free.stacked(displacement);
    };
    const MatrixFree identity_minus_S(free.size(), [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return x - S(x); });
    Eigen::GMRES<MatrixFree, Eigen::IdentityPreconditioner> gmres;
    gmres.set_restart(krylov_vectors);
    gmres.setMaxIterations(most_iterations);
    gmres.setTolerance(tolerance);
    gmres.compute(identity_minus_S);
    const Eigen::VectorXd right_hand_side = S(acceleration_m_s2.replicate(free.size() / 3, 1));
    const Eigen::VectorXd x = gmres.solve(right_hand_side);

    state.displacement_over_dt2 = free.at_vertices(x);
    state.residual = (x - S(x) - right_hand_side).norm() / right_hand_side.norm();
    state.converged = state.residual <= 10.0 * tolerance && softest * x.norm() <= right_hand_side.norm();
    return state;
}

}  // namespace experiments
