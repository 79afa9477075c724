#include "pbs/near_rest/near_rest.hpp"

#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/input_error.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseQR>
#include <unsupported/Eigen/IterativeSolvers>

#include <algorithm>
#include <functional>
#include <type_traits>

namespace pbs {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// The gradients of the volume of a tet with these vertices.
std::array<Vec3, 4> volume_gradients(const Positions& rest, const auto& vertex)
{
    const auto corner = [&](int c) -> Vec3 { return rest.row(vertex[c]); };
    return gradient(VolumeConstraint<double>{}, corner(0), corner(1), corner(2), corner(3));
}

// The rows of the vertices that move, one below the other, and back: the unknowns.
Eigen::VectorXd stacked(const Positions& at_vertices, const std::vector<int>& moving)
{
    const Positions rows = at_vertices(moving, Eigen::all);
    return rows.reshaped<Eigen::RowMajor>();
}

Positions unstacked(const Eigen::VectorXd& stack, const std::vector<int>& moving, Eigen::Index vertices)
{
    Positions at_vertices = Positions::Zero(vertices, 3);
    at_vertices(moving, Eigen::all) = stack.reshaped<Eigen::RowMajor>(static_cast<Eigen::Index>(moving.size()), 3);
    return at_vertices;
}

std::vector<int> those_in(const std::vector<bool>& set)
{
    std::vector<int> vertices;
    for (std::size_t v = 0; v < set.size(); ++v)
        if (set[v]) vertices.push_back(static_cast<int>(v));
    return vertices;
}

std::vector<bool> all_but(std::vector<bool> held)
{
    held.flip();
    return held;
}

constexpr double tolerance = 1e-8;
constexpr double softest =
    1e-9;  // where a step draws back less than this share of a displacement, nothing holds the body

// A linear map in place of a matrix, with the two operations that GMRES uses.
struct LinearMap {
    Eigen::Index size;
    std::function<Eigen::VectorXd(const Eigen::VectorXd&)> map;

    Eigen::Index rows() const { return size; }
    Eigen::VectorXd operator*(const Eigen::VectorXd& x) const { return map(x); }
};

std::array<Vec3, 1> gradients_at(const Positions& rest, const Positions& bind_point, const BindConstraint<double>& bind)
{
    return {gradient<double>(bind, rest.row(bind.vertex), bind_point.row(bind.vertex))};
}

std::array<Vec3, 2> gradients_at(const Positions& rest, const Positions&, const StretchConstraint<double>& edge)
{
    return gradient<double>(edge, rest.row(edge.vertex[0]), rest.row(edge.vertex[1]));
}

std::array<Vec3, 4> gradients_at(const Positions& rest, const Positions&, const VolumeConstraint<double>& tet)
{
    return volume_gradients(rest, tet.vertex);
}

}  // namespace

VolumeConstraints::VolumeConstraints(const TetMesh& mesh, const std::vector<bool>& held)
    : mesh_(mesh), free_(those_in(all_but(held))), place_(held.size(), -1)
{
    for (std::size_t i = 0; i < free_.size(); ++i) place_[free_[i]] = static_cast<int>(i);
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const std::array<Vec3, 4> gradients = volume_gradients(mesh.rest, mesh.tets.row(t));
        for (int c = 0; c < 4; ++c)
            for (int axis = 0; axis < 3 && place_[mesh.tets(t, c)] >= 0; ++axis)
                entries.emplace_back(t, 3 * place_[mesh.tets(t, c)] + axis, gradients[c](axis) / std::sqrt(volumes(t)));
    }
    gradients_.resize(mesh.tets.rows(), 3 * static_cast<Eigen::Index>(free_.size()));
    gradients_.setFromTriplets(entries.begin(), entries.end());
}

int VolumeConstraints::rank() const
{
    // The constraints are the columns; pivoting finds those that depend on the others.
    Eigen::SparseQR<Sparse, Eigen::COLAMDOrdering<int>> qr;
    qr.setPivotThreshold(1e-10);
    Sparse columns = gradients_.transpose();
    columns.makeCompressed();
    qr.compute(columns);
    return static_cast<int>(qr.rank());
}

Positions VolumeConstraints::equilibrium(const Positions& load_n, double shear_pa) const
{
    const double penalty =
        1e4;  // relative to the shear modulus: large enough to converge in a few rounds, small enough to keep digits
    const Sparse matrix = shear_stiffness() + penalty * Sparse(gradients_.transpose() * gradients_);
    const Eigen::SimplicialLDLT<Sparse> factor(matrix);
    const Eigen::VectorXd load = stacked(load_n, free_) / shear_pa;
    Eigen::VectorXd pressure = Eigen::VectorXd::Zero(gradients_.rows()), u = factor.solve(load);
    const double first = (gradients_ * u).norm();
    for (int round = 0; round < 20 && (gradients_ * u).norm() > 1e-9 * first; ++round) {
        pressure += penalty * (gradients_ * u);
        u = factor.solve(load - gradients_.transpose() * pressure);
    }
    return unstacked(u, free_, load_n.rows());
}

Sparse VolumeConstraints::shear_stiffness() const
{
    const Eigen::VectorXd volumes = tet_volumes(mesh_.rest, mesh_.tets);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index t = 0; t < mesh_.tets.rows(); ++t) {
        // of a shape function, times the volume
        const std::array<Vec3, 4> g = volume_gradients(mesh_.rest, mesh_.tets.row(t));
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b) {
                const int row = place_[mesh_.tets(t, a)], column = place_[mesh_.tets(t, b)];
                if (row < 0 || column < 0) continue;
                const Eigen::Matrix3d block =
                    (g[a].dot(g[b]) * Eigen::Matrix3d::Identity() + g[b] * g[a].transpose()) / volumes(t);
                for (int i = 0; i < 3; ++i)
                    for (int j = 0; j < 3; ++j) entries.emplace_back(3 * row + i, 3 * column + j, block(i, j));
            }
    }
    Sparse stiffness(dofs(), dofs());
    stiffness.setFromTriplets(entries.begin(), entries.end());
    return stiffness;
}

StepNearRest::StepNearRest(const Positions& rest, const Positions& bind_point, int iterations, double step_s,
                           bool forgets_multipliers)
    : rest_(rest), bind_point_(bind_point), iterations_(iterations), step_s_(step_s), forgets_(forgets_multipliers)
{
}

// A vertex on its bone, d = 0, is drawn to its material point whichever way it moves.
template <typename Constraint>
void StepNearRest::add(const Constraint& constraint, double share, double compliance,
                       const std::vector<double>& inverse_mass)
{
    const auto gradients = gradients_at(rest_, bind_point_, constraint);
    const bool is_bind = gradients.size() == 1;
    if (!is_bind || gradients[0].squaredNorm() > 0.0)
        return add_gradients(constraint, gradients, share, compliance, inverse_mass);
    for (int axis = 0; axis < 3; ++axis)
        add_gradients(constraint, std::array<Vec3, 1>{Vec3::Unit(axis)}, share, compliance, inverse_mass);
}

template void StepNearRest::add(const BindConstraint<double>&, double, double, const std::vector<double>&);
template void StepNearRest::add(const StretchConstraint<double>&, double, double, const std::vector<double>&);
template void StepNearRest::add(const VolumeConstraint<double>&, double, double, const std::vector<double>&);

template <typename Constraint, std::size_t count>
void StepNearRest::add_gradients(const Constraint& constraint, const std::array<Vec3, count>& gradients, double share,
                                 double compliance, const std::vector<double>& inverse_mass)
{
    Projection projection;
    projection.vertices = static_cast<int>(count);
    projection.share = share;
    projection.compliance_per_dt2 = compliance / (step_s_ * step_s_);
    double w_gradient2 = 0.0;
    std::fill(std::begin(projection.gradient), std::end(projection.gradient), Vec3::Zero());
    std::fill(std::begin(projection.moved), std::end(projection.moved), Vec3::Zero());
    for (std::size_t i = 0; i < count; ++i) {
        if constexpr (std::is_same_v<decltype(constraint.vertex), int>)
            projection.vertex[i] = constraint.vertex;
        else
            projection.vertex[i] = constraint.vertex[i];
        const double w = inverse_mass[projection.vertex[i]];
        projection.gradient[i] = gradients[i];
        projection.moved[i] = w * gradients[i];
        w_gradient2 += w * gradients[i].squaredNorm();
    }
    projection.denominator = projection.compliance_per_dt2 + w_gradient2;
    if (w_gradient2 > 0.0) projections_.push_back(projection);
}

void StepNearRest::apply(Positions& displacement)
{
    for (int iteration = 0; iteration < iterations_; ++iteration) {
        for (Projection& projection : projections_) {
            if (iteration == 0 || forgets_) projection.multiplier = 0.0;
            double C = 0.0;
            for (int i = 0; i < projection.vertices; ++i)
                C += displacement.row(projection.vertex[i]).dot(projection.gradient[i]);
            const double change = -projection.share * (C + projection.compliance_per_dt2 * projection.multiplier) /
                                  projection.denominator;
            projection.multiplier += change;
            for (int i = 0; i < projection.vertices; ++i)
                displacement.row(projection.vertex[i]) += change * projection.moved[i].transpose();
        }
    }
}

RestingState rest_of(StepNearRest& step, const std::vector<bool>& moves, const Vec3& acceleration_m_s2,
                     const KrylovSpace& space)
{
    const auto vertices = static_cast<Eigen::Index>(moves.size());
    const std::vector<int> moving = those_in(moves);
    RestingState state;
    const auto S = [&](const Eigen::VectorXd& x) {
        ++state.steps;
        Positions displacement = unstacked(x, moving, vertices);
        step.apply(displacement);
        return stacked(displacement, moving);
    };
    const auto count = static_cast<Eigen::Index>(moving.size());
    const LinearMap identity_minus_S{3 * count, [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return x - S(x); }};
    const Eigen::VectorXd right_hand_side = S(step.step_s() * step.step_s() * acceleration_m_s2.replicate(count, 1));
    Eigen::VectorXd x = Eigen::VectorXd::Zero(3 * count);
    Eigen::Index iterations = space.most_iterations;
    double error = tolerance;
    Eigen::internal::gmres(identity_minus_S, right_hand_side, x, Eigen::IdentityPreconditioner(), iterations,
                           Eigen::Index{space.vectors}, error);
    state.displacement = unstacked(x, moving, vertices);
    state.residual = (x - S(x) - right_hand_side).norm() / right_hand_side.norm();
    state.converged = state.residual <= 10.0 * tolerance && softest * x.norm() <= right_hand_side.norm();
    return state;
}

RestingState settle(const TetMesh& mesh, const std::vector<bool>& held, const PbsOptions& options,
                    const Vec3& acceleration_m_s2)
{
    if (options.volume_of != VolumeOf::tets) throw InputError("pbs", 0, "volume_of", "", "expected tets near rest");
    PbsOptions unbound = options;
    unbound.k_bind = 0.0;
    unbound.jiggle.reset();
    const auto constraints =
        make_constraint_set<double>(mesh, Eigen::VectorXd::Zero(mesh.rest.rows()), {}, unbound, held);
    StepNearRest step(mesh.rest, {}, options.iterations, 1.0);
    for (const auto& edge : constraints.stretch) step.add(edge, edge.stiffness, 0.0, constraints.inverse_mass);
    for (const auto& tet : constraints.volume) step.add(tet, tet.stiffness, 0.0, constraints.inverse_mass);
    return rest_of(step, all_but(held), acceleration_m_s2, {.vectors = 800, .most_iterations = 1600});
}

}  // namespace pbs
