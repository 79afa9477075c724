#include "reference_fem/potentials/potentials.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <limits>

namespace reference_fem {
namespace {

constexpr int most_points = 6;  // of a P2 tet
constexpr int most_nodes = 10;
using TetMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * most_nodes, 3 * most_nodes>;
using TetVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * most_nodes, 1>;
using Gradients = Eigen::Ref<const pbs::Positions>;  // of the shape functions, nodes x 3

Tangent without_negative_eigenvalues(const Tangent& tangent)
{
    const Eigen::SelfAdjointEigenSolver<Tangent> eigen(tangent);
    if (eigen.eigenvalues()(0) >= 0.0) return tangent;
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
}

// dF / du of node b is g_b(d) I in the rows of column d, so its block with node a is sum over c, d of g_a(c) A(c, d)
// g_b(d).
void add_material_blocks(const Tangent& tangent, const Gradients& gradients, double weight, TetMatrix& stiffness)
{
    for (Eigen::Index b = 0; b < gradients.rows(); ++b) {
        Eigen::Matrix<double, 9, 3> column = Eigen::Matrix<double, 9, 3>::Zero();
        for (int d = 0; d < 3; ++d) column += weight * gradients(b, d) * tangent.middleCols<3>(3 * d);
        for (Eigen::Index a = 0; a < gradients.rows(); ++a)
            for (int c = 0; c < 3; ++c)
                stiffness.block<3, 3>(3 * a, 3 * b) += gradients(a, c) * column.middleRows<3>(3 * c);
    }
}

// d (A : F) / du of a tet's nodes.
void add_nodal_forces(const Eigen::Matrix3d& stress, const Gradients& gradients, double weight, TetVector& force)
{
    for (Eigen::Index a = 0; a < gradients.rows(); ++a)
        force.segment<3>(3 * a) += weight * (stress * gradients.row(a).transpose());
}

}  // namespace

// The law's answer at every quadrature point of a tet, and the dilatation that its volume term uses there.
struct ElasticPotential::TetState {
    std::array<PointResponse, most_points> responses;
    std::array<double, most_points> dilatation;
    double volume_m3 = 0.0;
    bool defined = true;
};

ElasticPotential::ElasticPotential(const SimplexSpace& space, Model model, const Lame& lame, Formulation formulation)
    : ElasticPotential(space, model, lame, formulation, element_tables(space, space.element_order()))
{
}

ElasticPotential::ElasticPotential(const SimplexSpace& space, Model model, const Lame& lame, Formulation formulation,
                                   ElementTables tables)
    : tet_nodes_(space.tet_nodes()),
      model_(model),
      formulation_(formulation),
      law_(constitutive_law(model, lame)),
      tables_(std::move(tables))
{
    require(tables_.points_per_tet <= most_points, "quadrature points", tables_.points_per_tet,
            "expected at most 6 per tet");
    require(formulation != Formulation::taylor_hood, "formulation", "taylor_hood",
            "expected displacement or mean_dilatation here");
    require(formulation == Formulation::displacement || law_->volume_term(), "formulation", "mean_dilatation",
            "expected a law with a volume term lambda / 2 theta^2");
}

Eigen::Matrix3d ElasticPotential::deformation_gradient(const Eigen::VectorXd& displacement, Eigen::Index tet,
                                                       int q) const
{
    const auto gradients = tables_.gradients(tet, q);
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
    for (Eigen::Index a = 0; a < gradients.rows(); ++a)
        gradient += displacement.segment<3>(3 * tet_nodes_(tet, a)) * gradients.row(a);
    return gradient;
}

ElasticPotential::TetState ElasticPotential::evaluate(const Eigen::VectorXd& displacement, Eigen::Index tet,
                                                      Derivatives derivatives) const
{
    TetState state;
    double integral = 0.0;
    for (int q = 0; q < tables_.points_per_tet; ++q) {
        state.responses[q] = law_->evaluate(deformation_gradient(displacement, tet, q), derivatives);
        state.defined &= state.responses[q].defined;
        state.dilatation[q] = state.responses[q].dilatation;
        integral += tables_.weight(tet, q) * state.dilatation[q];
        state.volume_m3 += tables_.weight(tet, q);
    }
    if (formulation_ == Formulation::mean_dilatation) state.dilatation.fill(integral / state.volume_m3);
    return state;
}

double ElasticPotential::value(const Eigen::VectorXd& displacement) const
{
    double energy = 0.0;
    for (Eigen::Index tet = 0; tet < tet_nodes_.rows(); ++tet) {
        const TetState state = evaluate(displacement, tet, Derivatives::none);
        if (!state.defined) return std::numeric_limits<double>::infinity();
        for (int q = 0; q < tables_.points_per_tet; ++q)
            energy += tables_.weight(tet, q) *
                      (state.responses[q].shape + law_->lambda_pa() / 2.0 * state.dilatation[q] * state.dilatation[q]);
    }
    return energy;
}

void ElasticPotential::add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    const Eigen::Index nodes = tet_nodes_.cols();
    for (Eigen::Index tet = 0; tet < tet_nodes_.rows(); ++tet) {
        const TetState state = evaluate(displacement, tet, Derivatives::first);
        TetVector force = TetVector::Zero(3 * nodes);
        for (int q = 0; q < tables_.points_per_tet; ++q) {
            const PointResponse& response = state.responses[q];
            const Eigen::Matrix3d stress =
                response.shape_gradient + law_->lambda_pa() * state.dilatation[q] * response.dilatation_gradient;
            add_nodal_forces(stress, tables_.gradients(tet, q), tables_.weight(tet, q), force);
        }
        for (Eigen::Index a = 0; a < nodes; ++a) gradient.segment<3>(3 * tet_nodes_(tet, a)) += force.segment<3>(3 * a);
    }
}

void ElasticPotential::add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness,
                                   NodalMatrix& hessian) const
{
    const Eigen::Index nodes = tet_nodes_.cols();
    const double lambda_pa = law_->lambda_pa();
    const bool mean = formulation_ == Formulation::mean_dilatation;
    TetMatrix stiffness(3 * nodes, 3 * nodes);
    for (Eigen::Index tet = 0; tet < tet_nodes_.rows(); ++tet) {
        const TetState state = evaluate(displacement, tet, Derivatives::second);
        TetVector dilatation_force = TetVector::Zero(3 * nodes);  // d (V mean theta) / du
        stiffness.setZero();
        for (int q = 0; q < tables_.points_per_tet; ++q) {
            const PointResponse& response = state.responses[q];
            const Eigen::Map<const Eigen::Matrix<double, 9, 1>> direction(response.dilatation_gradient.data());
            Tangent tangent = response.shape_hessian + lambda_pa * state.dilatation[q] * response.dilatation_hessian;
            if (mean)
                add_nodal_forces(response.dilatation_gradient, tables_.gradients(tet, q), tables_.weight(tet, q),
                                 dilatation_force);
            else
                tangent += lambda_pa * direction * direction.transpose();
            if (definiteness == Definiteness::projected) tangent = without_negative_eigenvalues(tangent);
            add_material_blocks(tangent, tables_.gradients(tet, q), tables_.weight(tet, q), stiffness);
        }
        if (mean) stiffness += lambda_pa / state.volume_m3 * dilatation_force * dilatation_force.transpose();
        hessian.add_tet(tet, stiffness);
    }
}

Jacobians ElasticPotential::jacobians(const Eigen::VectorXd& displacement) const
{
    Jacobians jacobians;
    for (Eigen::Index tet = 0; tet < tet_nodes_.rows(); ++tet)
        for (int q = 0; q < tables_.points_per_tet; ++q) {
            const double jacobian = deformation_gradient(displacement, tet, q).determinant();
            jacobians.volume += tables_.weight(tet, q) * jacobian;
            jacobians.inverted += !(jacobian > 0.0);
            if (jacobians.lowest_tet >= 0 && jacobian >= jacobians.lowest) continue;
            jacobians.lowest = jacobian;
            jacobians.lowest_tet = static_cast<int>(tet);
        }
    return jacobians;
}

StiffnessPotential::StiffnessPotential(const NodalMatrix& stiffness)
    : stiffness_(stiffness.matrix()), centre_(Eigen::VectorXd::Zero(stiffness.matrix().rows()))
{
}

void StiffnessPotential::set(double coefficient, Eigen::VectorXd centre)
{
    coefficient_ = coefficient;
    centre_ = std::move(centre);
}

double StiffnessPotential::value(const Eigen::VectorXd& displacement) const
{
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(displacement.size());
    return value_and_add_gradient(displacement, gradient);
}

void StiffnessPotential::add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    value_and_add_gradient(displacement, gradient);
}

double StiffnessPotential::value_and_add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    const Eigen::VectorXd offset = displacement - centre_;
    // The matrix is symmetric: its columns are read as rows, which gathers instead of scattering.
    const Eigen::VectorXd force = coefficient_ * (stiffness_.transpose() * offset);
    gradient += force;
    return force.dot(offset) / 2.0;
}

void StiffnessPotential::add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix& hessian) const
{
    hessian.add(stiffness_, coefficient_);
}

NodalMatrix rest_stiffness(const SimplexSpace& space, const Potential& potential)
{
    NodalMatrix stiffness(space);
    potential.add_hessian(Eigen::VectorXd::Zero(space.dofs()), Definiteness::as_it_is, stiffness);
    return stiffness;
}

pbs::Vec3 BindPotential::offset(const Eigen::VectorXd& displacement, Eigen::Index vertex) const
{
    return rest_.row(vertex).transpose() + displacement.segment<3>(3 * vertex) - bind_points_.row(vertex).transpose();
}

double BindPotential::value(const Eigen::VectorXd& displacement) const
{
    double energy = 0.0;
    for (Eigen::Index v = 0; v < stiffness_.size(); ++v) {
        const double stretch = offset(displacement, v).norm() - distance_(v);
        energy += stiffness_(v) / 2.0 * stretch * stretch;
    }
    return energy;
}

// d/dx (|r| - d)^2 / 2 = (1 - d / |r|) r
void BindPotential::add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    for (Eigen::Index v = 0; v < stiffness_.size(); ++v) {
        const pbs::Vec3 r = offset(displacement, v);
        const double length = r.norm();
        if (length > 0.0) gradient.segment<3>(3 * v) += stiffness_(v) * (1.0 - distance_(v) / length) * r;
    }
}

// n n^T + (1 - d / |r|) (I - n n^T), n = r / |r|; at r = 0 the direction is not defined and only d = 0 has a Hessian.
void BindPotential::add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness,
                                NodalMatrix& hessian) const
{
    for (Eigen::Index v = 0; v < stiffness_.size(); ++v) {
        if (stiffness_(v) == 0.0) continue;
        const pbs::Vec3 r = offset(displacement, v);
        const double length = r.norm();
        const pbs::Vec3 n = length > 0.0 ? pbs::Vec3(r / length) : pbs::Vec3(pbs::Vec3::Zero());
        double across = length > 0.0 ? 1.0 - distance_(v) / length : 1.0;
        if (definiteness == Definiteness::projected) across = std::max(across, 0.0);
        const Eigen::Matrix3d along = n * n.transpose();
        hessian.add_block(int(v), int(v), stiffness_(v) * (along + across * (Eigen::Matrix3d::Identity() - along)));
    }
}

}  // namespace reference_fem
