#include "reference_fem/linear_flesh.hpp"

#include "reference_fem/potentials/potentials.hpp"

namespace reference_fem {
namespace {

constexpr int most_nodes = 10;
using TetMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * most_nodes, 3 * most_nodes>;
using Gradients = Eigen::Ref<const pbs::Positions>;  // of the shape functions at a quadrature point, nodes x 3

// Block (a, b): lambda g_a g_b^T + mu (g_b g_a^T + (g_a . g_b) I), times the weight.
void add_blocks(const Gradients& gradients, const Lame& material, double weight, TetMatrix& stiffness)
{
    for (Eigen::Index a = 0; a < gradients.rows(); ++a)
        for (Eigen::Index b = 0; b < gradients.rows(); ++b) {
            const Eigen::RowVector3d g_a = gradients.row(a), g_b = gradients.row(b);
            const Eigen::Matrix3d outer = weight * g_a.transpose() * g_b;
            auto block = stiffness.block<3, 3>(3 * a, 3 * b);
            block += material.lambda_pa * outer + material.mu_pa * outer.transpose();
            block.diagonal().array() += material.mu_pa * outer.trace();
        }
}

using Triplets = std::vector<Eigen::Triplet<double, SparseMatrix::StorageIndex>>;

// A quarter of a tet's volume at each corner. An affine function's products with the corners' shape functions N_v are
// integrated exactly from its corner values by the tet's P1 mass matrix: integral of N_v N_c = V / 20 (1 + delta_vc).
ElementTables corner_tables(const SimplexSpace& space)
{
    TetQuadrature corners{pbs::Positions::Zero(4, 3), Eigen::VectorXd::Constant(4, 1.0 / 24.0)};
    corners.points.bottomRows(3).setIdentity();
    return element_tables(space, corners);
}

double p1_mass(const ElementTables& corners, Eigen::Index tet, int v, int c)
{
    return corners.weight(tet, c) / 5.0 * (v == c ? 2.0 : 1.0);
}

// Integral of f g over a tet, both affine, by their values at the corners.
double integral_of_product(const ElementTables& corners, Eigen::Index tet, const Eigen::Vector4d& f,
                           const Eigen::Vector4d& g)
{
    return corners.weight(tet, 0) / 5.0 * (f.dot(g) + f.sum() * g.sum());
}

// div u at the corners of a tet.
Eigen::Vector4d corner_divergence(const ElementTables& corners, const TetNodes& tets, Eigen::Index tet,
                                  const Eigen::VectorXd& displacement)
{
    Eigen::Vector4d divergence = Eigen::Vector4d::Zero();
    for (int c = 0; c < 4; ++c)
        for (Eigen::Index a = 0; a < tets.cols(); ++a)
            divergence(c) += corners.gradients(tet, c).row(a).dot(displacement.segment<3>(3 * tets(tet, a)));
    return divergence;
}

// [ A    unit B^T            ]
// [ unit B   -unit^2 M / lambda ]; the columns of B^T are those of `divergence`.
SparseMatrix saddle_point(const SparseMatrix& shear, const SparseMatrix& divergence, const SparseMatrix& compliance)
{
    const Eigen::Index dofs = shear.rows(), pressures = compliance.rows();
    const SparseMatrix transposed = divergence.transpose();
    SparseMatrix whole(dofs + pressures, dofs + pressures);
    whole.reserve(shear.nonZeros() + 2 * divergence.nonZeros() + compliance.nonZeros());
    const auto stack = [&](Eigen::Index column, const SparseMatrix& upper, const SparseMatrix& lower,
                           Eigen::Index source) {
        whole.startVec(column);
        for (SparseMatrix::InnerIterator entry(upper, source); entry; ++entry)
            whole.insertBack(entry.row(), column) = entry.value();
        for (SparseMatrix::InnerIterator entry(lower, source); entry; ++entry)
            whole.insertBack(dofs + entry.row(), column) = entry.value();
    };
    for (Eigen::Index dof = 0; dof < dofs; ++dof) stack(dof, shear, transposed, dof);
    for (Eigen::Index v = 0; v < pressures; ++v) stack(dofs + v, divergence, compliance, v);
    whole.finalize();
    return whole;
}

ElasticPotential mean_dilatation(const SimplexSpace& space, const Lame& lame)
{
    return ElasticPotential(space, Model::linear, lame, Formulation::mean_dilatation);
}

}  // namespace

SparseMatrix stiffness_matrix(const SimplexSpace& space, const Lame& material)
{
    // Products of gradients have degree 2 (order - 1); n points per direction integrate degree 2 n - 1.
    const ElementTables tables = element_tables(space, space.element_order());
    NodalMatrix stiffness(space);
    TetMatrix of_tet(3 * tables.nodes_per_tet, 3 * tables.nodes_per_tet);
    for (Eigen::Index tet = 0; tet < space.tet_nodes().rows(); ++tet) {
        of_tet.setZero();
        for (int q = 0; q < tables.points_per_tet; ++q)
            add_blocks(tables.gradients(tet, q), material, tables.weight(tet, q), of_tet);
        stiffness.add_tet(tet, of_tet);
    }
    return std::move(stiffness).matrix();
}

LinearFlesh::LinearFlesh(const SimplexSpace& space, const Lame& lame, Formulation formulation,
                         const std::vector<int>& held_tets)
    : space_(space), lame_(lame), formulation_(formulation)
{
    if (formulation != Formulation::taylor_hood) return;
    require(space.element_order() == 2, "element_order", space.element_order(), "expected 2 with taylor_hood");
    require(lame.lambda_pa > 0.0, "poisson", lame.lambda_pa / (2.0 * (lame.lambda_pa + lame.mu_pa)),
            "expected > 0 with taylor_hood");
    const TetNodes& tets = space.tet_nodes();
    held_tet_.assign(tets.rows(), false);
    for (const int tet : held_tets) held_tet_[tet] = true;
    has_pressure_.assign(tets.leftCols(4).maxCoeff() + 1, false);
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner)
            if (!held_tet_[t]) has_pressure_[tets(t, corner)] = true;
    const double edge_m = std::cbrt(corner_tables(space).weights.sum() / static_cast<double>(tets.rows()));
    pressure_unit_pa_ = lame.mu_pa / edge_m;
}

int LinearFlesh::unknowns() const
{
    return space_.dofs() + pressures();
}

SparseMatrix LinearFlesh::stiffness() const
{
    if (formulation_ == Formulation::displacement) return stiffness_matrix(space_, lame_);
    if (formulation_ == Formulation::mean_dilatation)
        return rest_stiffness(space_, mean_dilatation(space_, lame_)).matrix();

    const ElementTables corners = corner_tables(space_);
    const TetNodes& tets = space_.tet_nodes();
    Triplets divergence, compliance;
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int v = 0; v < 4 && !held_tet_[t]; ++v) {
            pbs::Positions of_nodes = pbs::Positions::Zero(tets.cols(), 3);  // integral of N_v d N_a / d x
            for (int c = 0; c < 4; ++c) {
                of_nodes += p1_mass(corners, t, v, c) * corners.gradients(t, c);
                compliance.emplace_back(
                    tets(t, v), tets(t, c),
                    -pressure_unit_pa_ * pressure_unit_pa_ / lame_.lambda_pa * p1_mass(corners, t, v, c));
            }
            for (Eigen::Index a = 0; a < tets.cols(); ++a)
                for (int c = 0; c < 3; ++c)
                    divergence.emplace_back(3 * tets(t, a) + c, tets(t, v), pressure_unit_pa_ * of_nodes(a, c));
        }
    SparseMatrix divergence_matrix(space_.dofs(), pressures()), compliance_matrix(pressures(), pressures());
    divergence_matrix.setFromTriplets(divergence.begin(), divergence.end());
    compliance_matrix.setFromTriplets(compliance.begin(), compliance.end());
    return saddle_point(stiffness_matrix(space_, {0.0, lame_.mu_pa}), divergence_matrix, compliance_matrix);
}

std::vector<bool> LinearFlesh::prescribed(const std::vector<bool>& of_dofs) const
{
    std::vector<bool> of_unknowns = of_dofs;
    for (const bool solved_for : has_pressure_) of_unknowns.push_back(!solved_for);
    return of_unknowns;
}

LinearSolver LinearFlesh::solver(LinearSolver asked_for) const
{
    return formulation_ == Formulation::taylor_hood ? LinearSolver::umfpack : asked_for;
}

Eigen::VectorXd LinearFlesh::on_unknowns(const Eigen::VectorXd& of_dofs) const
{
    Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(this->unknowns());
    unknowns.head(space_.dofs()) = of_dofs;
    return unknowns;
}

Eigen::VectorXd LinearFlesh::displacement(const Eigen::VectorXd& unknowns) const
{
    return unknowns.head(space_.dofs());
}

Eigen::VectorXd LinearFlesh::pressure_pa(const Eigen::VectorXd& unknowns) const
{
    return pressure_unit_pa_ * unknowns.tail(pressures());
}

double LinearFlesh::strain_energy_j(const Eigen::VectorXd& displacement, const Eigen::VectorXd& pressure_pa) const
{
    if (formulation_ == Formulation::displacement) return strain_energy(space_, lame_, displacement);
    if (formulation_ == Formulation::mean_dilatation) return mean_dilatation(space_, lame_).value(displacement);

    double energy = strain_energy(space_, {0.0, lame_.mu_pa}, displacement);
    const ElementTables corners = corner_tables(space_);
    const TetNodes& tets = space_.tet_nodes();
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
        Eigen::Vector4d pressure = pressure_pa(tets.row(t).head<4>());
        if (held_tet_[t]) pressure = lame_.lambda_pa * corner_divergence(corners, tets, t, displacement);
        energy += integral_of_product(corners, t, pressure, pressure) / (2.0 * lame_.lambda_pa);
    }
    return energy;
}

double LinearFlesh::pressure_at_vertex_pa(const Eigen::VectorXd& displacement, const Eigen::VectorXd& pressure_pa,
                                          int vertex) const
{
    if (formulation_ == Formulation::taylor_hood) return pressure_pa(vertex);
    const ElementTables corners = corner_tables(space_);
    const TetNodes& tets = space_.tet_nodes();
    double sum = 0.0;
    int meeting = 0;
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) {
            if (tets(t, corner) != vertex) continue;
            const Eigen::Vector4d divergence = corner_divergence(corners, tets, t, displacement);
            sum += formulation_ == Formulation::mean_dilatation ? divergence.mean() : divergence(corner);
            ++meeting;
        }
    return lame_.lambda_pa * sum / meeting;
}

}  // namespace reference_fem
