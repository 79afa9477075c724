// Reference: rigid motion. M sums to the mass of the body, and a rigid velocity has the kinetic energy of mechanics. Tolerances: a term of
// v M v goes through the roundings of an entry, of its row and of the sum over the degrees of freedom.
#include "reference_fem/dynamics/consistent_mass.hpp"

#include "tests/support/element_rounding.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

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

}  // namespace
