// Cook's membrane: a tapered panel, corners (0,0), (48,44), (48,60), (0,44) mm, clamped on the left, a uniform shear on
// the right (R. Cook, J. Struct. Div. ASCE 100 (1974) 1851-1863). N and mm throughout.

#include "reference_fem/verification/problems.hpp"

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

RowSolution solved(int element_order, int n, const BoundaryValueSolution& solution)
{
    return {"cooks_membrane", elements_of(element_order), linear_material(1.0 / 3.0), text_of({n, n, 1}),
            16.0 / n * 1e-3,  solution.space->dofs()};
}

VerificationRow plane_strain_row(const Effort& effort, int element_order, int n)
{
    const BoundaryValueSolution solution =
        solve(membrane(n), solver_material(effort, {70.0, 1.0 / 3.0}), membrane_problem(6.25, true, element_order));
    VerificationRow row = row_about(solved(element_order, n, solution),
                                    {"corner_rise_plane_strain", "rise of the corner (48,60), plane strain"},
                                    solution.displacement_at({48, 60, 0}).y(), 32.24, "mm",
                                    "CoFEA benchmark 'Cook's membrane' (cofea.readthedocs.io), quadratic tets, very "
                                    "fine mesh: CalculiX 32.27, Code_Aster 32.20, "
                                    "Elmer 32.27 to 32.28 mm; the middle of their range");
    bound(row, row.reference - 0.08, row.reference + 0.08,
          "published scatter: no farther from the middle than the three codes are from each other");
    return row;
}

VerificationRow plane_stress_row(const Effort& effort, int element_order, int n)
{
    const BoundaryValueSolution solution = solve(membrane(n), solver_material(effort, {1.0, 1.0 / 3.0}),
                                                 membrane_problem(1.0 / 16.0, false, element_order));
    VerificationRow row =
        row_about(solved(element_order, n, solution),
                  {"edge_middle_rise_plane_stress", "rise of the right edge's middle (48,52), plane stress"},
                  solution.displacement_at({48, 52, 0}).y(), 23.96, "mm",
                  "R. Cook, D. Malkus, M. Plesha, R. Witt, Concepts and applications of finite element analysis, 4th "
                  "ed., Wiley 2002: 23.96, as "
                  "widely used");
    bound_by_grade_a(row);
    row.note =
        "a slab of 1 mm with free faces for plane stress; texts that give 23.96 for the corner mean this point: the "
        "corner rises by 25.1";
    return row;
}

}  // namespace small_strain

VerificationRows cooks_membrane_rows(const Effort& effort)
{
    using namespace small_strain;
    VerificationRows rows;
    for (const auto make_row : {plane_strain_row, plane_stress_row}) {
        rows.push_back(make_row(effort, 1, effort.full ? 32 : 16));
        unbound(rows.back());
        for (const int n : {8, 16, 32}) {
            rows.push_back(make_row(effort, 2, n));
            if (n < 32) unbound(rows.back());
        }
    }
    return rows;
}

// Cook's membrane at finite strain, as in the program Quasi-Static Finite-Strain Compressible Elasticity of deal.II's
// code gallery: an isochoric neo-Hookean panel, mu = 0.4225 N/mm^2, nu = 0.3, a dead shear load of 1/16 N/mm^2. Its
// value of 14.33 mm belongs to free z faces. With u_z held (plane strain) the corner rises by 13.77 mm. If the faces
// are free and the middle plane is not held, the panel buckles sideways at 1/40 of the load, where the Hessian is no
// longer positive definite.

namespace finite_strain {

constexpr double shear_modulus = 0.4225, poisson = 0.3;

VerificationRow row_of(const Effort& effort, bool plane_strain, int element_order, int n)
{
    const ElasticMaterial material{2.0 * shear_modulus * (1.0 + poisson), poisson};
    const FiniteStrainSolution solution =
        solve_at_finite_strain(membrane(n), solver_material(effort, material), Model::isochoric_neo_hookean,
                               membrane_problem(1.0 / 16.0, plane_strain, element_order), {.first_step = 0.2});
    VerificationRow row = row_about(
        {"cooks_membrane_finite_strain", elements_of(element_order), material_of("isochoric_neo_hookean", poisson),
         text_of({n, n, 1}), 16.0 / n * 1e-3, solution.space->dofs()},
        plane_strain ? RowQuantity{"corner_rise_plane_strain", "rise of the corner (48,60), plane strain"}
                     : RowQuantity{"corner_rise_free_faces", "rise of the corner (48,60), free faces"},
        solution.path.converged() ? solution.displacement_at({48, 60, 0}).y() : not_reached,
        plane_strain ? 13.77 : 14.33, "mm",
        plane_strain ? "our earlier implementation of the same problem with u_z held: regression, no outside truth"
                     : "deal.II code gallery, Quasi-Static Finite-Strain Compressible Elasticity (J.-P. Pelteret, A. "
                       "McBride, 2016), fine mesh");
    row.note = std::to_string(solution.path.newton_steps()) + " Newton steps";
    if (element_order == 2 && !plane_strain) bound_by_grade_a(row);
    return row;
}

}  // namespace finite_strain

VerificationRows cooks_membrane_finite_strain_rows(const Effort& effort)
{
    using namespace finite_strain;
    VerificationRows rows;
    for (const bool plane_strain : {false, true})
        for (const int element_order : {1, 2})
            rows.push_back(row_of(effort, plane_strain, element_order, effort.full ? 32 : 16));
    return rows;
}

}  // namespace reference_fem
