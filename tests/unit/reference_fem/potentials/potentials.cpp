// Reference: the algebra of c / 2 (u - u0)^T A (u - u0), and the energy of the linear law, which its matrix must give. Tolerances: a sum of
// products of which each goes through at most m roundings by eps / 2 is in error by at most m eps / 2 times the sum of their magnitudes
// (N. Higham, Accuracy and stability of numerical algorithms, 2nd ed., SIAM 2002, Sec. 3.1); two evaluations differ by twice that.
#include "reference_fem/potentials/potentials.hpp"

#include "reference_fem/dynamics/time_stepper.hpp"

#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace reference_fem;

constexpr double eps = std::numeric_limits<double>::epsilon();

class QuadraticForm : public testing::TestWithParam<int> {
protected:
    // Checks that value, gradient and Hessian are those of c / 2 (u - u0)^T A (u - u0), separately and together.
    void expect_form(const Potential& potential, const SparseMatrix& A, double c) const
    {
        const Eigen::VectorXd offset = u - u0, gradient = c * (A * offset);
        const double value = c / 2.0 * offset.dot(A * offset);
        // m: the product and sum of a row, of the dofs' products for the value, and the factor c.
        const Eigen::VectorXd magnitudes = c * (SparseMatrix(A.cwiseAbs()) * offset.cwiseAbs());
        const int row = most_entries(A);
        const double value_error = (row + u.size() + 3) * eps * magnitudes.dot(offset.cwiseAbs()) / 2.0;
        // The gradient is added to ones, and these are taken away again: two more roundings of at most the gradient and one.
        const double gradient_error = (row + 3) * eps * magnitudes.norm() + eps * std::sqrt(u.size());
        Eigen::VectorXd alone = Eigen::VectorXd::Ones(u.size()), together = alone;
        potential.add_gradient(u, alone);
        EXPECT_NEAR(potential.value_and_add_gradient(u, together), value, value_error);
        EXPECT_NEAR(potential.value(u), value, value_error);
        EXPECT_LT((alone - Eigen::VectorXd::Ones(u.size()) - gradient).norm(), gradient_error);
        EXPECT_LT(value_error, 1e-10 * value) << "a bound that would let a wrong entry pass proves nothing";
        EXPECT_EQ(alone, together);
        NodalMatrix hessian(space);
        potential.add_hessian(u, Definiteness::projected, hessian);
        EXPECT_EQ((hessian.matrix() - c * A).norm(), 0.0);  // the same products, each rounded once
        EXPECT_TRUE(potential.is_quadratic());
    }

    static int most_entries(const SparseMatrix& A)  // of a row
    {
        int most = 0;
        for (Eigen::Index i = 0; i < A.outerSize(); ++i) most = std::max<int>(most, A.col(i).nonZeros());
        return most;
    }

    const SimplexSpace space{test_support::jittered_cube(2), GetParam()};
    const ElasticPotential law{space, Model::linear, lame_parameters(1e3, 0.3), Formulation::displacement};
    const Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(space.dofs(), -1.0, 2.0).array().sin(),
                          u0 = Eigen::VectorXd::LinSpaced(space.dofs(), 0.0, 3.0).array().cos();
};

TEST_P(QuadraticForm, OfAStiffness)
{
    const NodalMatrix stiffness = rest_stiffness(space, law);
    StiffnessPotential potential(stiffness);
    potential.set(2.5, u0);
    expect_form(potential, stiffness.matrix(), 2.5);
}

TEST_P(QuadraticForm, OfTheMass)
{
    const ConsistentMass mass(space, 7.0);
    InertiaPotential potential(mass);
    potential.set(40.0, u0);
    expect_form(potential, mass.matrix(), 40.0);
}

// With G = I + grad u in absolute values, s = |G| at a quadrature point and B = mu + 3/2 lambda, the terms of the energy add up to at most
// w B s^2, and those of a node's force to w 2 B s |grad N|. m by the tets: the sum over nodes, six of the strain and eleven of the law,
// points and tets; by the matrix: an entry's nine products, points, at most 24 tets about a vertex, and the product with the matrix.
TEST_P(QuadraticForm, AsItIsIsTheLinearLaw)
{
    const NodalMatrix stiffness = rest_stiffness(space, law);
    const StiffnessPotential potential(stiffness);
    const ElementTables tables = element_tables(space, GetParam());
    const Lame lame = lame_parameters(1e3, 0.3);
    const double bound_pa = lame.mu_pa + 1.5 * lame.lambda_pa;
    double energy = 0.0;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(space.nodes());
    for (Eigen::Index tet = 0; tet < space.tet_nodes().rows(); ++tet)
        for (int q = 0; q < tables.points_per_tet; ++q) {
            const pbs::Positions gradients = tables.gradients(tet, q);
            Eigen::Matrix3d sums = Eigen::Matrix3d::Identity();
            for (int a = 0; a < tables.nodes_per_tet; ++a)
                sums += u.segment<3>(3 * space.tet_nodes()(tet, a)).cwiseAbs() * gradients.row(a).cwiseAbs();
            energy += tables.weight(tet, q) * bound_pa * sums.squaredNorm();
            for (int a = 0; a < tables.nodes_per_tet; ++a)
                force(space.tet_nodes()(tet, a)) += tables.weight(tet, q) * 2.0 * bound_pa * sums.norm() * gradients.row(a).norm();
        }
    const int of_tets = tables.nodes_per_tet + 6 + 11 + tables.points_per_tet + 24,
              of_matrix = 9 + tables.points_per_tet + 24 + most_entries(stiffness.matrix()) + 2;
    const double roundings = (of_tets + of_matrix) * eps / 2.0, sums = (space.dofs() + space.tet_nodes().rows()) * eps / 2.0;
    EXPECT_NEAR(potential.value(u), law.value(u), (roundings + sums) * energy);
    Eigen::VectorXd by_matrix = Eigen::VectorXd::Zero(u.size()), by_tets = by_matrix;
    potential.add_gradient(u, by_matrix);
    law.add_gradient(u, by_tets);
    EXPECT_LT((by_matrix - by_tets).norm(), roundings * force.norm());
    EXPECT_LT(roundings * force.norm(), 1e-10 * by_tets.norm()) << "a bound that would let a wrong entry pass proves nothing";
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, QuadraticForm, testing::Values(1, 2));

}  // namespace
