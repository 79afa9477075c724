#include "experiments/studies/shared/near_rest/step_near_rest.hpp"

#include <unsupported/Eigen/IterativeSolvers>

#include <algorithm>
#include <functional>
#include <utility>

namespace experiments {
namespace {
class MatrixFree;
}
}  // namespace experiments

template <>
struct Eigen::internal::traits<experiments::MatrixFree> : Eigen::internal::traits<Eigen::SparseMatrix<double>> {
};

namespace experiments {
namespace {

// A linear map as Eigen's iterative solvers take it: a product instead of a matrix.
class MatrixFree : public Eigen::EigenBase<MatrixFree> {
public:
    using Scalar = double;
    using RealScalar = double;
    using StorageIndex = int;
    enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic, IsRowMajor = false };
    using Map = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

    MatrixFree(Eigen::Index size, Map map) : size_(size), map_(std::move(map)) {}

    Eigen::Index rows() const { return size_; }
    Eigen::Index cols() const { return size_; }
    Eigen::VectorXd apply(const Eigen::VectorXd& vector) const { return map_(vector); }

    template <typename Vector>
    Eigen::Product<MatrixFree, Vector, Eigen::AliasFreeProduct> operator*(const Eigen::MatrixBase<Vector>& vector) const
    {
        return {*this, vector.derived()};
    }

private:
    Eigen::Index size_;
    Map map_;
};

}  // namespace
}  // namespace experiments

template <typename Vector>
struct Eigen::internal::generic_product_impl<experiments::MatrixFree, Vector, Eigen::SparseShape, Eigen::DenseShape, Eigen::GemvProduct>
    : generic_product_impl_base<experiments::MatrixFree, Vector, generic_product_impl<experiments::MatrixFree, Vector>> {
    template <typename Target>
    static void scaleAndAddTo(Target& target, const experiments::MatrixFree& matrix, const Vector& vector, const double& scale)
    {
        target.noalias() += scale * matrix.apply(vector);
    }
};

namespace experiments {
namespace {

using pbs::Positions;
using pbs::Vec3;

constexpr double tolerance = 1e-8;
constexpr double softest = 1e-9;  // nothing draws back what is moved by less than this share of it in a step

// The rows of the vertices that move, stacked, and back: the unknowns.
struct StackedRows {
    explicit StackedRows(const std::vector<bool>& moves) : vertices(static_cast<Eigen::Index>(moves.size()))
    {
        for (std::size_t v = 0; v < moves.size(); ++v)
            if (moves[v]) moving.push_back(static_cast<int>(v));
    }

    Eigen::Index size() const { return 3 * static_cast<Eigen::Index>(moving.size()); }

    Eigen::VectorXd stacked(const Positions& displacement) const
    {
        Eigen::VectorXd stack(size());
        for (std::size_t i = 0; i < moving.size(); ++i)
            stack.segment<3>(3 * static_cast<Eigen::Index>(i)) = displacement.row(moving[i]).transpose();
        return stack;
    }

    Positions at_vertices(const Eigen::VectorXd& stack) const
    {
        Positions displacement = Positions::Zero(vertices, 3);
        for (std::size_t i = 0; i < moving.size(); ++i)
            displacement.row(moving[i]) = stack.segment<3>(3 * static_cast<Eigen::Index>(i)).transpose();
        return displacement;
    }

    Eigen::Index vertices;
    std::vector<int> moving;
};

std::array<Vec3, 1> gradients_at(const Positions& rest, const Positions& bind_point, const pbs::BindConstraint<double>& bind)
{
    return {gradient<double>(bind, rest.row(bind.vertex), bind_point.row(bind.vertex))};
}

std::array<Vec3, 2> gradients_at(const Positions& rest, const Positions&, const pbs::StretchConstraint<double>& edge)
{
    return gradient<double>(edge, rest.row(edge.vertex[0]), rest.row(edge.vertex[1]));
}

std::array<Vec3, 4> gradients_at(const Positions& rest, const Positions&, const pbs::VolumeConstraint<double>& tet)
{
    const auto corner = [&](int c) -> Vec3 { return rest.row(tet.vertex[c]); };
    return gradient<double>(tet, corner(0), corner(1), corner(2), corner(3));
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

StepNearRest::StepNearRest(const Positions& rest, const Positions& bind_point, int iterations, double step_s, bool forgets_multipliers)
    : rest_(rest), bind_point_(bind_point), iterations_(iterations), step_s_(step_s), forgets_(forgets_multipliers)
{
}

// A vertex on its bone, d = 0, is drawn to its material point whichever way it moves.
template <typename Constraint>
void StepNearRest::add(const Constraint& constraint, double share, double compliance, const std::vector<double>& inverse_mass)
{
    const auto gradients = gradients_at(rest_, bind_point_, constraint);
    const bool is_bind = gradients.size() == 1;
    if (!is_bind || gradients[0].squaredNorm() > 0.0) return add_gradients(constraint, gradients, share, compliance, inverse_mass);
    for (int axis = 0; axis < 3; ++axis) add_gradients(constraint, std::array<Vec3, 1>{Vec3::Unit(axis)}, share, compliance, inverse_mass);
}

template void StepNearRest::add(const pbs::BindConstraint<double>&, double, double, const std::vector<double>&);
template void StepNearRest::add(const pbs::StretchConstraint<double>&, double, double, const std::vector<double>&);
template void StepNearRest::add(const pbs::VolumeConstraint<double>&, double, double, const std::vector<double>&);

template <typename Constraint, std::size_t count>
void StepNearRest::add_gradients(const Constraint& constraint, const std::array<Vec3, count>& gradients, double share, double compliance,
                                 const std::vector<double>& inverse_mass)
{
    Projection projection;
    projection.vertices = static_cast<int>(count);
    projection.share = share;
    projection.compliance_per_dt2 = compliance / (step_s_ * step_s_);
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
    projection.denominator = projection.compliance_per_dt2 + w_gradient2;
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

RestingState rest_of(StepNearRest& step, const std::vector<bool>& moves, const Vec3& acceleration_m_s2, const KrylovSpace& space)
{
    const StackedRows moving(moves);
    RestingState state;
    const auto S = [&](const Eigen::VectorXd& x) {
        ++state.steps;
        Positions displacement = moving.at_vertices(x);
        step.apply(displacement);
        return moving.stacked(displacement);
    };
    const MatrixFree identity_minus_S(moving.size(), [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return x - S(x); });
    Eigen::GMRES<MatrixFree, Eigen::IdentityPreconditioner> gmres;
    gmres.set_restart(space.vectors);
    gmres.setMaxIterations(space.most_iterations);
    gmres.setTolerance(tolerance);
    gmres.compute(identity_minus_S);
    const Eigen::VectorXd right_hand_side = S(step.step_s() * step.step_s() * acceleration_m_s2.replicate(moving.size() / 3, 1));
    const Eigen::VectorXd x = gmres.solve(right_hand_side);
    state.displacement = moving.at_vertices(x);
    state.residual = (x - S(x) - right_hand_side).norm() / right_hand_side.norm();
    state.converged = state.residual <= 10.0 * tolerance && softest * x.norm() <= right_hand_side.norm();
    return state;
}

RestingState settle(const pbs::TetMesh& mesh, const std::vector<bool>& held, const pbs::PbsOptions& options, const Vec3& acceleration_m_s2)
{
    pbs::PbsOptions unbound = options;
    unbound.k_bind = 0.0;
    unbound.jiggle.reset();
    const auto constraints = pbs::make_constraint_set<double>(mesh, Eigen::VectorXd::Zero(mesh.rest.rows()), {}, unbound, held);
    StepNearRest step(mesh.rest, {}, options.iterations, 1.0);
    for (const auto& edge : constraints.stretch) step.add(edge, edge.stiffness, 0.0, constraints.inverse_mass);
    for (const auto& tet : constraints.volume) step.add(tet, tet.stiffness, 0.0, constraints.inverse_mass);
    std::vector<bool> moves = held;
    moves.flip();
    return rest_of(step, moves, acceleration_m_s2, {.vectors = 800, .most_iterations = 1600});
}

}  // namespace experiments
