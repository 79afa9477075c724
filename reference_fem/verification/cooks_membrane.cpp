// Cook's membrane: a tapered panel, corners (0,0), (48,44), (48,60), (0,44) mm, clamped on the left, a uniform shear on the right
// (R. Cook, J. Struct. Div. ASCE 100 (1974) 1851-1863). N and mm throughout.

#include "reference_fem/verification/problems.hpp"

#include <limits>

namespace reference_fem {

using pbs::Vec3;

constexpr double half_thickness = 0.5;

pbs::TetMesh membrane(int n)
{
    return mapped(box_mesh({0, 0, 0}, {48, 44, half_thickness}, {n, n, 1}), [](const Vec3& p) -> Vec3 {
        const double bottom = 44.0 / 48.0 * p.x(), top = 44.0 + 16.0 / 48.0 * p.x();
        return {p.x(), bottom + (top - bottom) * p.y() / 44.0, p.z()};
    });
}

BoundaryValueProblem membrane_problem(double shear, bool plane_strain, int element_order)
{
    const auto held = [=](const Vec3& x) {
        const bool held_across = x.z() < 1e-9 || (plane_strain && x.z() > half_thickness - 1e-9);
        return x.x() < 1e-9 ? Held(true) : Held(false, false, held_across);
    };
    return {.held = held,
            .element_order = element_order,
            .tractions = {{[](const Vec3& centre) { return centre.x() > 48.0 - 1e-9; },
                           [=](const Vec3&, const Vec3&) -> Vec3 {
                               return {0, shear, 0};
                           }}}};
}

namespace small_strain {

BoundaryValueSolution bend(const Effort& effort, const ElasticMaterial& material, double shear, bool plane_strain, int element_order, int n)
{
    return solve(membrane(n), solver_material(effort, material), membrane_problem(shear, plane_strain, element_order));
}

VerificationRow row_of(int element_order, int n, const BoundaryValueSolution& solution)
{
    return {.problem = "cooks_membrane",
            .elements = elements_of(element_order),
            .material = linear_material(1.0 / 3.0),
            .mesh = text_of({n, n, 1}),
            .h_m = 16.0 / n * 1e-3,
            .dofs = solution.space->dofs(),
            .unit = "mm"};
}

VerificationRow plane_strain_row(const Effort& effort, int element_order, int n)
{
    const BoundaryValueSolution solution = bend(effort, {70.0, 1.0 / 3.0}, 6.25, true, element_order, n);
    VerificationRow row = row_of(element_order, n, solution);
    row.quantity = {"corner_rise_plane_strain", "rise of the corner (48,60), plane strain"};
    row.value = solution.displacement_at({48, 60, 0}).y();
    row.reference = 32.24;
    row.source =
        "CoFEA benchmark 'Cook's membrane' (cofea.readthedocs.io), quadratic tets, very fine mesh: CalculiX 32.27, Code_Aster 32.20, "
        "Elmer 32.27 to 32.28 mm; the middle of their range";
    row.low = row.reference - 0.08;
    row.high = row.reference + 0.08;
    row.bound_from = "published scatter: no farther from the middle than the three codes are from each other";
    return row;
}

VerificationRow plane_stress_row(const Effort& effort, int element_order, int n)
{
    const BoundaryValueSolution solution = bend(effort, {1.0, 1.0 / 3.0}, 1.0 / 16.0, false, element_order, n);
    VerificationRow row = row_of(element_order, n, solution);
    row.quantity = {"edge_middle_rise_plane_stress", "rise of the right edge's middle (48,52), plane stress"};
    row.value = solution.displacement_at({48, 52, 0}).y();
    row.reference = 23.96;
    row.source =
        "R. Cook, D. Malkus, M. Plesha, R. Witt, Concepts and applications of finite element analysis, 4th ed., Wiley 2002: 23.96, as "
        "widely used";
    bound_by_grade_a(row);
    row.note =
        "a slab of 1 mm with free faces for plane stress; texts that give 23.96 for the corner mean this point: the corner rises by 25.1";
    return row;
}

}  // namespace small_strain

VerificationRows cooks_membrane_rows(const Effort& effort)
{
    using namespace small_strain;
    VerificationRows rows;
    for (const auto make_row : {plane_strain_row, plane_stress_row}) {
        VerificationRow linear = make_row(effort, 1, effort.full ? 32 : 16);
        linear.low = linear.high = std::nullopt;
        linear.bound_from.clear();
        rows.push_back(linear);
        for (const int n : {8, 16, 32}) {
            rows.push_back(make_row(effort, 2, n));
            if (n == 32) continue;
            rows.back().low = rows.back().high = std::nullopt;
            rows.back().bound_from.clear();
        }
    }
    return rows;
}

// Cook's membrane at finite strain, as in the program Quasi-Static Finite-Strain Compressible Elasticity of deal.II's code gallery: an
// isochoric neo-Hookean panel, mu = 0.4225 N/mm^2, nu = 0.3, a dead shear load of 1/16 N/mm^2. Its value of 14.33 mm belongs to free z
// faces. With u_z held (plane strain) the corner rises by 13.77 mm. If the faces are free and the middle plane is not held, the panel
// buckles sideways at 1/40 of the load, where the Hessian is no longer positive definite.

namespace finite_strain {

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

}  // namespace finite_strain

VerificationRows cooks_membrane_finite_strain_rows(const Effort& effort)
{
    using namespace finite_strain;
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
