// Reference: theory. The normal integrates to zero over a closed surface, and x . n to three times the volume. A bar on rollers under
// uniform tension has an affine displacement and a uniform stress. Tolerances: rounding of a direct solve, by cond(K), and of sums over
// nodes of entries, into which the normal brings the Jacobian once more. The magnitudes of all shape functions at a point add up to at
// most 2.
#include "reference_fem/boundary_value_problem.hpp"

#include "tests/support/element_rounding.hpp"
#include "tests/support/solve_rounding.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Vec3;

class BoundaryData : public testing::TestWithParam<int> {
protected:
    static double sum_error(const SimplexSpace& space, double area)
    {
        const double of_entry = test_support::entry_roundings(space, GetParam() + 1, 1) + test_support::jacobian_roundings(space);
        return test_support::rounding_error(of_entry + space.nodes(), 2.0 * area);
    }

    const pbs::TetMesh cube = test_support::jittered_cube(3);
};

TEST_P(BoundaryData, AUniformPressureAddsUpToNothingAndDoesTheWorkOfTheVolume)
{
    const SimplexSpace space(cube, GetParam());
    const Eigen::VectorXd load =
        traction_load(space, {[](const Vec3&) { return true; }, [](const Vec3&, const Vec3& normal) { return normal; }});
    const Eigen::Map<const pbs::Positions> forces(load.data(), space.nodes(), 3);
    const double rounding = sum_error(space, 6.0), farthest = std::sqrt(3.0);
    EXPECT_LT(forces.colwise().sum().norm(), rounding);
    EXPECT_NEAR((forces.array() * space.node_positions().array()).sum(), 3.0, farthest * rounding);
    EXPECT_LT(rounding, 1e-11) << "a bound that would let a wrong face pass proves nothing";
}

TEST_P(BoundaryData, OnlyTheFacesThatAreAskedForAreLoaded)
{
    const SimplexSpace space(cube, GetParam());
    const auto on_top = [](const Vec3& centre) { return centre.z() > 1.0 - 1e-9; };
    const Eigen::VectorXd load = traction_load(space, {on_top, [](const Vec3& x, const Vec3&) -> Vec3 { return {0, 0, x.x()}; }});
    const Eigen::Map<const pbs::Positions> forces(load.data(), space.nodes(), 3);
    EXPECT_LT((forces.colwise().sum() - Eigen::RowVector3d(0, 0, 0.5)).norm(), sum_error(space, 1.0));
    // Away from a face a shape function is zero to the rounding of its terms, of at most 3. The faces of six tets about a node have a third
    // of the area.
    for (int node = 0; node < space.nodes(); ++node)
        if (space.node_positions()(node, 2) < 1.0 - 1e-9) {
            EXPECT_LT(forces.row(node).norm(), test_support::rounding_error(8, 3.0 / 3.0));
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
    const test_support::SolveRounding rounding = test_support::rounding_of(solution, material);
    EXPECT_LT(rounding.relative(), 1e-9) << "a bound that would let an error of a percent pass proves nothing";
    EXPECT_LT(test_support::relative_error(solution, exact), rounding.relative());
    EXPECT_LT((solution.displacement_at({1, 1, 1}) - exact({1, 1, 1})).norm(), rounding.error_m());
    const Eigen::Matrix3d stress = Vec3(tension_pa, 0, 0).asDiagonal();
    for (const Vec3& point : {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(0.33, 0.33, 0.66)})
        EXPECT_LT((solution.stress_at(point, material) - stress).norm(),
                  rounding.stress_pa(lame_parameters(material.young_pa, material.poisson), cube));
    EXPECT_NEAR(solution.work_of_load_j(), tension_pa * strain, rounding.error_m() * solution.load.norm());
    const double energy_j = tension_pa * strain / 2.0;
    EXPECT_NEAR(solution.strain_energy_j(material), energy_j, rounding.energy_j(energy_j));
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, BoundaryData, testing::Values(1, 2));

}  // namespace
