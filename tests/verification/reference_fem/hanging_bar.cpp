// Reference: closed form (Timoshenko and Goodier, Theory of elasticity, art. 96). A bar along x, held at x = 0, under its own weight w
// [N/m^3] along x has sigma_xx = w (L - x) and no other stress: eps_xx = sigma_xx / E, eps_yy = eps_zz = -nu eps_xx, no shear. The
// displacement is quadratic: P2 tets reproduce it up to rounding, sqrt(n) eps cond(K). P1 tets converge with at least order 1 in the H1
// seminorm (the L2 order is below 2, since the dual problem is singular where the held face meets free ones).
#include "reference_fem/boundary_value_problem.hpp"

#include "tests/support/solve_rounding.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Vec3;

const ElasticMaterial material{1.0e5, 0.3};
const double length_m = 1.0, weight_n_m3 = 9810.0;

Vec3 exact(const Vec3& p)
{
    const double x = p(0), y = p(1) - 0.5, z = p(2) - 0.5, slope = weight_n_m3 / material.young_pa, nu = material.poisson;
    return {slope * (length_m * x - x * x / 2.0 - nu * (y * y + z * z) / 2.0), -nu * slope * (length_m - x) * y,
            -nu * slope * (length_m - x) * z};
}

Eigen::Matrix3d exact_gradient(const Vec3& p)
{
    const double x = p(0), y = p(1) - 0.5, z = p(2) - 0.5, slope = weight_n_m3 / material.young_pa, nu = material.poisson;
    Eigen::Matrix3d gradient;
    gradient << length_m - x, -nu * y, -nu * z, nu * y, -nu * (length_m - x), 0.0, nu * z, 0.0, -nu * (length_m - x);
    return slope * gradient;
}

BoundaryValueSolution hang(int cells, int element_order)
{
    return solve(test_support::jittered_cube(cells), material,
                 {.body_force = [](const Vec3&) -> Vec3 {
                      return {weight_n_m3, 0, 0};
                  },
                  .displacement = exact,
                  .held = [](const Vec3& p) { return p(0) < 1e-9; },
                  .element_order = element_order});
}

TEST(HangingBar, QuadraticTetsAreExact)
{
    const BoundaryValueSolution solution = hang(4, 2);
    const double bound = rounding_bound(spectrum(solution, material));
    EXPECT_LT(test_support::relative_error(solution, exact), bound);
    EXPECT_LT(bound, 1e-9) << "a bound that would let an error of a percent pass proves nothing";
}

// W = integral of sigma_xx^2 / (2 E) = w^2 L^3 / (6 E) over the unit cross-section.
TEST(HangingBar, StoredEnergyIsTheClosedForm)
{
    const double energy = weight_n_m3 * weight_n_m3 / (6.0 * material.young_pa);
    const BoundaryValueSolution solution = hang(4, 2);
    EXPECT_NEAR(solution.strain_energy_j(material), energy, test_support::rounding_of(solution, material).energy_j(energy));
}

// Cea's lemma is an upper bound: at least order 1, minus 0.1 for two meshes of similar size.
TEST(HangingBar, LinearTetsApproachWithOrderOneOrBetter)
{
    const double coarse = hang(6, 1).errors(exact, exact_gradient).h1_seminorm,
                 fine = hang(12, 1).errors(exact, exact_gradient).h1_seminorm;
    EXPECT_GT(std::log2(coarse / fine), 0.9);
}

}  // namespace
