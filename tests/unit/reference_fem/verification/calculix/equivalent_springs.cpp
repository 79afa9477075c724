// Reference: the energy of the springs themselves, sum_s k_s / 2 |X_s + u(X_s) - t_s|^2, for a displacement that the elements represent
// exactly: linear with P1, quadratic with P2.
#include "reference_fem/verification/calculix/equivalent_springs.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/unit/reference_fem/verification/calculix/one_tet_problem.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace reference_fem;

class EquivalentSpringsOfOrder : public testing::TestWithParam<int> {
protected:
    EquivalentSpringsOfOrder()
    {
        constexpr int springs = 50;
        problem_.springs.points.resize(springs, 3);
        problem_.springs.targets.resize(springs, 3);
        problem_.springs.stiffness_n_m.resize(springs);
        for (int s = 0; s < springs; ++s) {
            Eigen::Vector4d barycentric;
            for (double& coordinate : barycentric) coordinate = number(0.1, 1.0);
            problem_.springs.points.row(s) = (barycentric / barycentric.sum()).transpose() * problem_.nodes.topRows(4);
            for (double& component : problem_.springs.targets.row(s)) component = number(-1.0, 1.0);
            problem_.springs.stiffness_n_m(s) = number(1.0, 1000.0);
        }
    }

    double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

    // Linear with P1, quadratic with P2.
    Eigen::RowVector3d displacement(const Eigen::RowVector3d& x, double size) const
    {
        const double quadratic = GetParam() == 2 ? 1.0 : 0.0;
        return size * Eigen::RowVector3d(0.3 - x(1) + quadratic * x(0) * x(2), 2.0 * x(0) + x(2) - quadratic * x(1) * x(1),
                                         0.1 + quadratic * x(2) * x(0));
    }

    double energy_of_all(double size) const
    {
        const GroundSprings& springs = problem_.springs;
        double energy = 0.0;
        for (Eigen::Index s = 0; s < springs.points.rows(); ++s) {
            const Eigen::RowVector3d point = springs.points.row(s);
            energy += springs.stiffness_n_m(s) / 2.0 * (point + displacement(point, size) - springs.targets.row(s)).squaredNorm();
        }
        return energy;
    }

    double energy_of(const EquivalentSprings& few, double size) const
    {
        pbs::Positions at_nodes = problem_.nodes;
        for (auto row : at_nodes.rowwise()) row = displacement(row, size);
        double energy = -few.forces_n.cwiseProduct(at_nodes).sum();
        for (const EquivalentSpring& spring : few.springs) {
            Eigen::RowVector3d end = Eigen::RowVector3d::Zero();
            for (Eigen::Index i = 0; i < problem_.tets.cols(); ++i)
                end += spring.coefficients(i) * at_nodes.row(problem_.tets(spring.tet, i));
            energy += few.stiffness_n_m / 2.0 * end.squaredNorm();
        }
        return energy;
    }

    std::mt19937_64 random_{3};
    NodalProblem problem_ = test_support::one_tet_problem(GetParam());
};

// Each side is a sum of less than 1000 products, whose magnitudes have a sum of at most some 1e5 J. Eigenvalues that are left out change it
// by eps times that.
TEST_P(EquivalentSpringsOfOrder, HaveTheEnergyOfAllButForAConstant)
{
    const EquivalentSprings few = equivalent_springs(problem_);
    EXPECT_LE(few.springs.size(), static_cast<std::size_t>(problem_.tets.cols()));
    for (const double size : {0.5, -2.0})
        EXPECT_NEAR(energy_of(few, size), energy_of_all(size) - energy_of_all(0.0), test_support::rounding_error(1000, 1e5));
}

TEST_P(EquivalentSpringsOfOrder, CoefficientsFitIntoADeck)
{
    double largest = 0.0;
    for (const EquivalentSpring& spring : equivalent_springs(problem_).springs)
        largest = std::max(largest, spring.coefficients.squaredNorm());
    EXPECT_NEAR(largest, 1.0, test_support::rounding_error(20, 1.0));
}

TEST_P(EquivalentSpringsOfOrder, LeaveOutPointsOutsideTheFlesh)
{
    const double inside = energy_of(equivalent_springs(problem_), 1.0);
    problem_.springs.points.conservativeResize(51, 3);
    problem_.springs.targets.conservativeResize(51, 3);
    problem_.springs.stiffness_n_m.conservativeResize(51);
    problem_.springs.points.row(50) << 0.5, 0.5, 0.5;
    problem_.springs.targets.row(50).setOnes();
    problem_.springs.stiffness_n_m(50) = 1000.0;
    EXPECT_EQ(energy_of(equivalent_springs(problem_), 1.0), inside);
}

TEST_P(EquivalentSpringsOfOrder, AreNoneWhereThereIsNone)
{
    problem_.springs = {};
    const EquivalentSprings none = equivalent_springs(problem_);
    EXPECT_TRUE(none.springs.empty());
    EXPECT_TRUE(none.forces_n.isZero(0.0));
}

INSTANTIATE_TEST_SUITE_P(ElementOrders, EquivalentSpringsOfOrder, testing::Values(1, 2));

// Each is 1 at its own node and 0 at the others; node 4 + k is in the middle of edge k.
TEST(TetShapeFunctions, AreOneAtTheirNode)
{
    for (const int nodes : {4, 10}) {
        const NodalProblem problem = test_support::one_tet_problem(nodes == 4 ? 1 : 2);
        Eigen::Matrix4d corners;
        for (int i = 0; i < 4; ++i) corners.col(i) << 1.0, problem.nodes.row(problem.tets(0, i)).transpose();
        for (int i = 0; i < nodes; ++i) {
            Eigen::Vector4d point;
            point << 1.0, problem.nodes.row(problem.tets(0, i)).transpose();
            const Eigen::VectorXd shapes = tet_shape_functions(corners.inverse() * point, nodes);
            EXPECT_LE((shapes - Eigen::VectorXd::Unit(nodes, i)).cwiseAbs().maxCoeff(), test_support::rounding_error(40, 1.0));
        }
    }
}

}  // namespace
