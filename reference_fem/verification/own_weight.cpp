// A bar along x, held at x = 0 as the closed form moves there, under its own weight w [N/m^3] along x: sigma_xx = w (L - x) and nothing
// else. The displacement is quadratic, so P2 tets return it to rounding (S. Timoshenko, J. Goodier, Theory of elasticity, art. 96).
#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/rounding_bound.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

namespace reference_fem {
namespace {

using pbs::Vec3;

const ElasticMaterial material{1.0e5, 0.3};
constexpr double length_m = 1.0, weight_n_m3 = 9810.0;

Vec3 exact(const Vec3& point)
{
    const double x = point.x(), y = point.y() - 0.5, z = point.z() - 0.5, slope = weight_n_m3 / material.young_pa, nu = material.poisson;
    return {slope * (length_m * x - x * x / 2.0 - nu * (y * y + z * z) / 2.0), -nu * slope * (length_m - x) * y,
            -nu * slope * (length_m - x) * z};
}

}  // namespace

VerificationRows own_weight_rows(const Effort& effort)
{
    const int n = 2;
    const BoundaryValueSolution solution = solve(jittered_cube(n, 0.25), solver_material(effort, material),
                                                 {.body_force = [](const Vec3&) -> Vec3 {
                                                      return {weight_n_m3, 0, 0};
                                                  },
                                                  .displacement = exact,
                                                  .held = [](const Vec3& x) { return x.x() < 1e-9; },
                                                  .element_order = 2});
    return {{.problem = "own_weight",
             .quantity = {"nodal_error", "largest nodal error over largest displacement"},
             .elements = elements_of(2),
             .material = linear_material(material.poisson),
             .mesh = text_of({n, n, n}) + " jittered",
             .h_m = 1.0 / n,
             .dofs = solution.space->dofs(),
             .value = solution.largest_nodal_error(exact) / exact({length_m, 0.0, 0.0}).norm(),
             .unit = "1",
             .source = "closed form: bar hanging under its own weight (Timoshenko and Goodier, Theory of elasticity, art. 96)",
             .low = 0.0,
             .high = rounding_bound(spectrum(solution, material)),
             .bound_from = rounding_bound_text}};
}

}  // namespace reference_fem
