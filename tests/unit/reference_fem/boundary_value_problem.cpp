// Reference: theory. The normal integrates to zero over a closed surface, and x . n to three times the volume. A bar on rollers under
// uniform tension has an affine displacement and a uniform stress. Tolerance: the condition number of some 1e4 times eps, with a margin:
// 1e-11.
#include "reference_fem/boundary_value_problem.hpp"

#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Vec3;

class BoundaryData : public testing::TestWithParam<int> {
protected:
    const pbs::TetMesh cube = test_support::jittered_cube(3);
};

TEST_P(BoundaryData, AUniformPressureAddsUpToNothingAndDoesTheWorkOfTheVolume)
{
    const SimplexSpace space(cube, GetParam());
    const Eigen::VectorXd load =
        traction_load(space, {[](const Vec3&) { return true; }, [](const Vec3&, const Vec3& normal) { return normal; }});
    const Eigen::Map<const pbs::Positions> forces(load.data(), space.nodes(), 3);
    EXPECT_LT(forces.colwise().sum().norm(), 1e-13);
    EXPECT_NEAR((forces.array() * space.node_positions().array()).sum(), 3.0, 1e-12);
}

TEST_P(BoundaryData, OnlyTheFacesThatAreAskedForAreLoaded)
{
    const SimplexSpace space(cube, GetParam());
    const auto on_top = [](const Vec3& centre) { return centre.z() > 1.0 - 1e-9; };
    const Eigen::VectorXd load = traction_load(space, {on_top, [](const Vec3& x, const Vec3&) -> Vec3 { return {0, 0, x.x()}; }});
    const Eigen::Map<const pbs::Positions> forces(load.data(), space.nodes(), 3);
    EXPECT_LT((forces.colwise().sum() - Eigen::RowVector3d(0, 0, 0.5)).norm(), 1e-13);
    for (int node = 0; node < space.nodes(); ++node)
        if (space.node_positions()(node, 2) < 1.0 - 1e-9) {
            EXPECT_LT(forces.row(node).norm(), 1e-15);
        }
}

TEST_P(BoundaryData, ABarOnRollersIsStretchedUniformly)
{
    const ElasticMaterial material{2.0e5, 0.3};
    const double tension_pa = 1.0e3, strain = tension_pa / material.young_pa;
    const auto exact = [&](const Vec3& x) -> Vec3 { return strain * Vec3(x.x(), -material.poisson * x.y(), -material.poisson * x.z()); };
    const BoundaryValueSolution solution =
        solve(cube, material,
              {.held = [](const Vec3& x) { return Held(x.x() < 1e-9, x.y() < 1e-9, x.z() < 1e-9); },
               .element_order = GetParam(),
               .tractions = {{[](const Vec3& centre) { return centre.x() > 1.0 - 1e-9; },
                              [&](const Vec3&, const Vec3& normal) -> Vec3 { return tension_pa * normal; }}}});
    EXPECT_LT(solution.largest_nodal_error(exact), 1e-11 * strain);
    EXPECT_LT((solution.displacement_at({1, 1, 1}) - exact({1, 1, 1})).norm(), 1e-11 * strain);
    const Eigen::Matrix3d stress = Vec3(tension_pa, 0, 0).asDiagonal();
    for (const Vec3& point : {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(0.33, 0.33, 0.66)})
        EXPECT_LT((solution.stress_at(point, material) - stress).norm(), 1e-10 * tension_pa);
    EXPECT_NEAR(solution.work_of_load_j(), tension_pa * strain, 1e-11 * tension_pa * strain);
    EXPECT_NEAR(solution.strain_energy_j(material), tension_pa * strain / 2.0, 1e-11 * tension_pa * strain);
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, BoundaryData, testing::Values(1, 2));

}  // namespace
