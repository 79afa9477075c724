// Cook's membrane at finite strain, as in the program Quasi-Static Finite-Strain Compressible Elasticity of deal.II's code gallery: an
// isochoric neo-Hookean panel, mu = 0.4225 N/mm^2, nu = 0.3, a dead shear load of 1/16 N/mm^2. Its value of 14.33 mm belongs to free z
// faces. With u_z held (plane strain) the corner rises by 13.77 mm. If the faces are free and the middle plane is not held, the panel
// buckles sideways at 1/40 of the load, where the Hessian is no longer positive definite.
#include "reference_fem/finite_strain_problem.hpp"
#include "reference_fem/verification/membrane.hpp"

#include <limits>

namespace reference_fem {
namespace {

constexpr double shear_modulus = 0.4225, poisson = 0.3;

VerificationRow row_of(const Effort& effort, bool plane_strain, int element_order, int n)
{
    const ElasticMaterial material{2.0 * shear_modulus * (1.0 + poisson), poisson};
    const FiniteStrainSolution solution =
        solve_at_finite_strain(membrane(n), solver_material(effort, material), Model::isochoric_neo_hookean,
                               membrane_problem(1.0 / 16.0, plane_strain, element_order), {.first_step = 0.2});
    return {.problem = "cooks_membrane_finite_strain",
            .quantity = plane_strain ? RowQuantity{"corner_rise_plane_strain", "rise of the corner (48,60), plane strain"}
                                     : RowQuantity{"corner_rise_free_faces", "rise of the corner (48,60), free faces"},
            .elements = elements_of(element_order),
            .material = material_of("isochoric_neo_hookean", poisson),
            .mesh = text_of({n, n, 1}),
            .h_m = 16.0 / n * 1e-3,
            .dofs = solution.space->dofs(),
            .value = solution.path.converged() ? solution.displacement_at({48, 60, 0}).y() : std::numeric_limits<double>::quiet_NaN(),
            .unit = "mm",
            .note = std::to_string(solution.path.newton_steps()) + " Newton steps"};
}

}  // namespace

VerificationRows cooks_membrane_finite_strain_rows(const Effort& effort)
{
    VerificationRows rows;
    for (const bool plane_strain : {false, true})
        for (const int element_order : {1, 2}) {
            VerificationRow row = row_of(effort, plane_strain, element_order, effort.full ? 32 : 16);
            row.reference = plane_strain ? 13.77 : 14.33;
            row.source =
                "deal.II code gallery, Quasi-Static Finite-Strain Compressible Elasticity (J.-P. Pelteret, A. McBride, 2016), fine mesh";
            if (plane_strain) row.source = "our earlier implementation of the same problem with u_z held: regression, no outside truth";
            if (element_order == 2 && !plane_strain) bound_by_grade_a(row);
            rows.push_back(row);
        }
    return rows;
}

}  // namespace reference_fem
