// Reference: rigid motion. M sums to the mass of the body, and a rigid velocity has the kinetic energy of mechanics.
#include "reference_fem/dynamics/consistent_mass.hpp"

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
};

TEST_P(Mass, OfATranslationIsThatOfTheBody)
{
    const pbs::Vec3 velocity(1.0, -2.0, 0.5);
    const Eigen::VectorXd v = field(Eigen::Matrix3d::Zero(), velocity);
    EXPECT_NEAR(v.dot(mass.times(v)), 3.0 * velocity.squaredNorm(), 1e-12);
}

// A unit cube of density 3 that rotates about the z axis through its corner: I = 3 (1/3 + 1/3).
TEST_P(Mass, OfARotationIsTheMomentOfInertia)
{
    Eigen::Matrix3d spin = Eigen::Matrix3d::Zero();
    spin(0, 1) = -1.0;
    spin(1, 0) = 1.0;
    const Eigen::VectorXd v = field(spin, pbs::Vec3::Zero());
    EXPECT_NEAR(v.dot(mass.times(v)), 2.0, 1e-12);
}

TEST_P(Mass, AsAMatrixAndAsBlocksIsTheSameOperator)
{
    const Eigen::VectorXd v = field(Eigen::Matrix3d::Random(), pbs::Vec3(1, 2, 3)).cwiseAbs2();
    NodalMatrix blocks(space);
    mass.add_to(blocks, 2.0);
    const Eigen::VectorXd product = mass.times(v);
    EXPECT_LT((mass.matrix() * v - product).norm(), 1e-14 * product.norm());
    EXPECT_LT((blocks.matrix() * v - 2.0 * product).norm(), 1e-14 * product.norm());
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, Mass, testing::Values(1, 2));

}  // namespace
