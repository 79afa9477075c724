// Reference: the algebra of c / 2 (u - u0)^T A (u - u0), and the energy of the linear law, which its matrix must give.
#include "reference_fem/potentials/stiffness_potential.hpp"

#include "reference_fem/dynamics/inertia_potential.hpp"
#include "reference_fem/potentials/elastic_potential.hpp"

#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;

class QuadraticForm : public testing::TestWithParam<int> {
protected:
    // Checks that value, gradient and Hessian are those of c / 2 (u - u0)^T A (u - u0), separately and together.
    void expect_form(const Potential& potential, const SparseMatrix& A, double c) const
    {
        const Eigen::VectorXd offset = u - u0, gradient = c * (A * offset);
        const double value = c / 2.0 * offset.dot(A * offset);
        Eigen::VectorXd alone = Eigen::VectorXd::Ones(u.size()), together = alone;
        potential.add_gradient(u, alone);
        EXPECT_NEAR(potential.value_and_add_gradient(u, together), value, 1e-12 * value);
        EXPECT_NEAR(potential.value(u), value, 1e-12 * value);
        EXPECT_LT((alone - Eigen::VectorXd::Ones(u.size()) - gradient).norm(), 1e-12 * gradient.norm());
        EXPECT_EQ(alone, together);
        NodalMatrix hessian(space);
        potential.add_hessian(u, Definiteness::projected, hessian);
        EXPECT_LT((hessian.matrix() - c * A).norm(), 1e-14 * c * A.norm());
        EXPECT_TRUE(potential.is_quadratic());
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

TEST_P(QuadraticForm, AsItIsIsTheLinearLaw)
{
    const StiffnessPotential potential(rest_stiffness(space, law));
    EXPECT_NEAR(potential.value(u), law.value(u), 1e-11 * law.value(u));
    Eigen::VectorXd by_matrix = Eigen::VectorXd::Zero(u.size()), by_tets = by_matrix;
    potential.add_gradient(u, by_matrix);
    law.add_gradient(u, by_tets);
    EXPECT_LT((by_matrix - by_tets).norm(), 1e-12 * by_tets.norm());
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, QuadraticForm, testing::Values(1, 2));

}  // namespace
