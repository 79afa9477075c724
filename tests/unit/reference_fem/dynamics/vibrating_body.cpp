// Reference: rigid motion. M sums to the mass of the body, and a rigid velocity has the kinetic energy of mechanics. Tolerances: a term of
// v M v goes through the roundings of an entry, of its row and of the sum over the degrees of freedom.

#include "reference_fem/dynamics/time_stepper.hpp"
#include "reference_fem/dynamics/vibrating_body.hpp"
#include "tests/support/element_rounding.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace {

using namespace reference_fem;

class Mass : public testing::TestWithParam<int> {
protected:
    const SimplexSpace space{test_support::jittered_cube(2), GetParam()};
    const ConsistentMass mass{space, 3.0};

    Eigen::VectorXd field(const Eigen::Matrix3d& gradient, const pbs::Vec3& constant) const
    {
        Eigen::VectorXd values(space.dofs());
        for (int node = 0; node < space.nodes(); ++node)
            values.segment<3>(3 * node) = gradient * space.node_positions().row(node).transpose() + constant;
        return values;
    }

    double product_error(const Eigen::VectorXd& v) const
    {
        const double roundings =
            test_support::entry_roundings(space, GetParam() + 1, 2) + test_support::most_entries(mass.matrix()) + space.dofs();
        return test_support::rounding_error(roundings, v.cwiseAbs().dot(test_support::magnitudes(mass.matrix()) * v.cwiseAbs()));
    }
};

TEST_P(Mass, OfATranslationIsThatOfTheBody)
{
    const pbs::Vec3 velocity(1.0, -2.0, 0.5);
    const Eigen::VectorXd v = field(Eigen::Matrix3d::Zero(), velocity);
    EXPECT_NEAR(v.dot(mass.times(v)), 3.0 * velocity.squaredNorm(), product_error(v));
    EXPECT_LT(product_error(v), 1e-9) << "a bound that would let a wrong entry pass proves nothing";
}

// A unit cube of density 3 that rotates about the z axis through its corner: I = 3 (1/3 + 1/3).
TEST_P(Mass, OfARotationIsTheMomentOfInertia)
{
    Eigen::Matrix3d spin = Eigen::Matrix3d::Zero();
    spin(0, 1) = -1.0;
    spin(1, 0) = 1.0;
    const Eigen::VectorXd v = field(spin, pbs::Vec3::Zero());
    EXPECT_NEAR(v.dot(mass.times(v)), 2.0, product_error(v));
}

// The three products have the same terms, and each goes through the product and the sum of a row.
TEST_P(Mass, AsAMatrixAndAsBlocksIsTheSameOperator)
{
    const Eigen::VectorXd v = field(Eigen::Matrix3d::Random(), pbs::Vec3(1, 2, 3)).cwiseAbs2();
    NodalMatrix blocks(space);
    mass.add_to(blocks, 2.0);
    const Eigen::VectorXd product = mass.times(v);
    const SparseMatrix matrix = mass.matrix();
    const double row = test_support::rounding_error(test_support::most_entries(matrix), (matrix.cwiseAbs() * v).norm());
    EXPECT_LE((matrix * v - product).norm(), 2.0 * row);
    EXPECT_LE((blocks.matrix() * v - 2.0 * product).norm(), 2.0 * 2.0 * row);
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, Mass, testing::Values(1, 2));

// Reference: a dense eigenvalue problem by Eigen. Tolerances: both reduce it to eigenvalues of L^-1 K L^-T with M = L L^T, whose error by
// rounding is sqrt(n) eps |K| |M^-1| (G. Golub, C. Van Loan, Matrix Computations, 4th ed., Sec. 8.7.2), and omega is the root of an
// eigenvalue. The iteration ends at a change of the shape of 1e-13; (K - omega^2 M) turns it and the rounding of the solve into a residual.

std::vector<int> free_dofs(const VibratingBody& body)
{
    std::vector<int> free;
    for (int i = 0; i < body.space().dofs(); ++i)
        if (!body.fixed()[i]) free.push_back(i);
    return free;
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric)
{
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

TEST(FirstMode, IsTheLowestOfADenseEigenvalueProblem)
{
    const VibratingBody body(test_support::jittered_cube(2), {.held = [](const pbs::Vec3& x) { return x.z() < 1e-9; }});
    const Mode mode = body.first_mode();
    NodalMatrix stiffness(body.space());
    body.flesh().add_hessian(Eigen::VectorXd::Zero(body.space().dofs()), Definiteness::as_it_is, stiffness);
    const std::vector<int> free = free_dofs(body);
    const Eigen::MatrixXd K = Eigen::MatrixXd(stiffness.matrix())(free, free), M = Eigen::MatrixXd(body.mass().matrix())(free, free);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(K, M);
    const double c = std::sqrt(static_cast<double>(free.size())) * std::numeric_limits<double>::epsilon(), lowest = dense.eigenvalues()(0),
                 norm_of_K = eigenvalues(K).maxCoeff();
    const double omega_bound = c * norm_of_K / eigenvalues(M).minCoeff() / lowest;
    EXPECT_NEAR(mode.omega_rad_s, std::sqrt(lowest), omega_bound * mode.omega_rad_s);
    EXPECT_LT(omega_bound, 1e-8) << "a bound that would let an error of a percent pass proves nothing";
    const Eigen::VectorXd phi = mode.shape(free);
    EXPECT_LT((K * phi - mode.omega_rad_s * mode.omega_rad_s * (M * phi)).norm(), (1e-13 + c) * norm_of_K * phi.norm());
    EXPECT_EQ(mode.shape.cwiseAbs().maxCoeff(), 1.0);
}

TEST(FirstMode, OfABodyThatMayMoveRigidlyIsNotANumber)
{
    EXPECT_TRUE(std::isnan(VibratingBody(test_support::jittered_cube(1), {}).first_mode().omega_rad_s));
}

TEST(FirstMode, WithEveryDegreeOfFreedomPrescribedIsNotANumber)
{
    const VibratingBody body(test_support::jittered_cube(1), {.held = [](const pbs::Vec3&) { return true; }});
    EXPECT_TRUE(std::isnan(body.first_mode().omega_rad_s));
}

}  // namespace
