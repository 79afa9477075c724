// A cantilever, 10 x 1 x 1 m, clamped whole at one end, a uniform shear traction of 1 N on the other.
//
//   #|========================|  | P      tip deflection = P L^3 / (3 E I) + P L / (k G A)
//   #|========================|  v        k = 10 (1 + nu) / (12 + 11 nu)
//
// The solid differs from the beam near its ends, over one depth by Saint-Venant's principle: a clamp that holds the
// anticlastic curvature bends as a plate there, 1 - nu^2 as much, and the first depth h of a tip-loaded cantilever
// makes 3 h / L of its deflection; at either end the warping of the cross-section may be free or held, which is at most
// the shear deflection of one depth.

#include "reference_fem/verification/problems.hpp"

namespace reference_fem {
namespace tip_load {

using pbs::Vec3;

constexpr double length_m = 10.0, depth_m = 1.0, force_n = 1.0, young_pa = 1.0e5;

struct BeamTheory {
    double deflection_m, clamp_m,
        shear_m;  // the whole; what the clamp may take from it; the shear deflection of one depth
};

BeamTheory timoshenko(double nu)
{
    const double area = depth_m * depth_m, inertia = area * area / 12.0, shear_pa = young_pa / (2.0 * (1.0 + nu));
    const double k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
    const double bending = force_n * length_m * length_m * length_m / (3.0 * young_pa * inertia);
    return {bending + force_n * length_m / (k * shear_pa * area), 3.0 * nu * nu * depth_m / length_m * bending,
            force_n * depth_m / (k * shear_pa * area)};
}

}  // namespace tip_load

VerificationRow cantilever_row(const Effort& effort, double nu, int element_order, Formulation formulation,
                               const Divisions& divisions)
{
    using namespace tip_load;
    const ElasticMaterial material{young_pa, nu};
    const BoundaryValueSolution solution =
        solve(box_mesh({0, 0, 0}, {length_m, depth_m, depth_m}, divisions), solver_material(effort, material),
              {.held = [](const Vec3& x) { return x.x() < 1e-9; },
               .element_order = element_order,
               .tractions = {{[](const Vec3& centre) { return centre.x() > length_m - 1e-9; },
                              [](const Vec3&, const Vec3&) -> Vec3 {
                                  return {0, 0, -force_n / (depth_m * depth_m)};
                              }}},
               .formulation = formulation});
    const BeamTheory theory = timoshenko(nu);
    VerificationRow row = row_about(
        {"cantilever", elements_of(element_order, formulation), linear_material(nu), text_of(divisions),
         depth_m / divisions[1], solution.space->dofs()},
        {"tip_deflection", "tip deflection"}, solution.work_of_load_j() / force_n, theory.deflection_m, "m",
        "closed form: Timoshenko's beam, shear coefficient of G. R. Cowper, J. Appl. Mech. 33 (1966) 335-340");
    if (element_order == 1)
        row.note = "P1 is too stiff in bending; its convergence is judged by the manufactured solution";
    else
        bound(row, theory.deflection_m - theory.clamp_m - theory.shear_m, theory.deflection_m + theory.shear_m,
              "solid against beam: 3 nu^2 h / L of the bending for the held anticlastic curvature, the shear "
              "deflection of one depth");
    return row;
}

VerificationRows cantilever_rows(const Effort& effort)
{
    using namespace tip_load;
    VerificationRows rows;
    for (const double nu : {0.0, 0.3})
        for (const int element_order : {1, 2})
            for (const int n : {3, 6, 12})
                if (n < 12 || (effort.full && element_order == 1))
                    rows.push_back(cantilever_row(effort, nu, element_order, Formulation::displacement, {8 * n, n, n}));
    return rows;
}

// The share of bending and torsion that remains as Poisson's ratio approaches 1/2, by element: linear tets have about
// as many volumes to keep as displacements to keep them with, and lock.
//   bending: the cantilever of cantilever.cpp, against Timoshenko's beam
//   torsion: the bar of turned_bars.cpp; Saint-Venant's solution changes no volume, so its torque does not depend on
//            Poisson's ratio
// Only formulations for nearly incompressible materials (reference_fem/options.hpp) have bounds.

namespace locking {

const std::vector<double> quick_ladder = {0.3, 0.49, 0.499, 0.49999};
const std::vector<double> full_ladder = {0.3, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999};

struct Element {
    int order;
    Formulation formulation;
};

VerificationRow as_locking(VerificationRow row, const Element& element)
{
    row.problem = "locking";
    row.note.clear();
    if (element.formulation == Formulation::displacement) unbound(row);
    return row;
}

}  // namespace locking

VerificationRows locking_rows(const Effort& effort)
{
    using namespace locking;
    VerificationRows rows;
    const int cube = effort.full ? 8 : 4;
    for (const Element& element : {Element{1, Formulation::displacement}, Element{2, Formulation::displacement},
                                   Element{2, Formulation::mean_dilatation}, Element{2, Formulation::taylor_hood}})
        for (const double nu : effort.full ? full_ladder : quick_ladder) {
            rows.push_back(
                as_locking(cantilever_row(effort, nu, element.order, element.formulation, {48, 6, 6}), element));
            VerificationRow torsion = torsion_row(effort, nu, element.order, element.formulation, cube);
            bound_by_grade_a(torsion);
            rows.push_back(as_locking(torsion, element));
        }
    return rows;
}

// A soft cantilever, 0.6 x 0.12 x 0.12 m, under its own weight: E = 1 MPa, nu = 0.3, 1000 kg/m^3, of the size and
// stiffness of flesh. w = weight per length; deflection = w L^4 / (8 E I) + w L^2 / (2 k G A). Near the clamp the solid
// differs from the beam as in cantilever.cpp; the first depth h makes 4 h / L of the bending deflection here.

namespace gravity {

using pbs::Vec3;

constexpr double length_m = 0.6, depth_m = 0.12, density_kg_m3 = 1000.0, gravity_m_s2 = 9.81;
const ElasticMaterial material{1.0e6, 0.3};

VerificationRow row_of(const Effort& effort, int element_order, int n)
{
    const Divisions divisions = {5 * n, n, n};
    const BoundaryValueSolution solution =
        solve(box_mesh({0, 0, 0}, {length_m, depth_m, depth_m}, divisions), solver_material(effort, material),
              {.body_force = [](const Vec3&) -> Vec3 {
                   return {0, 0, -density_kg_m3 * gravity_m_s2};
               },
               .held = [](const Vec3& x) { return x.x() < 1e-9; },
               .element_order = element_order});

    const double nu = material.poisson, area = depth_m * depth_m, inertia = area * area / 12.0;
    const double weight_n_m = density_kg_m3 * gravity_m_s2 * area,
                 k_g_a = 10.0 * material.young_pa / (2.0 * (12.0 + 11.0 * nu)) * area;
    const double bending = weight_n_m * std::pow(length_m, 4) / (8.0 * material.young_pa * inertia);
    const double shear = weight_n_m * length_m * length_m / (2.0 * k_g_a);
    const double shear_of_a_depth = weight_n_m * length_m * depth_m / k_g_a;
    VerificationRow row =
        row_about({"gravity_cantilever", elements_of(element_order), linear_material(nu), text_of(divisions),
                   depth_m / n, solution.space->dofs()},
                  {"end_deflection", "deflection of the end's middle"},
                  -solution.displacement_at({length_m, depth_m / 2.0, depth_m / 2.0}).z(), bending + shear, "m",
                  "closed form: Timoshenko's beam under uniform load, shear coefficient of G. R. Cowper, J. Appl. "
                  "Mech. 33 (1966) 335-340");
    if (element_order == 1)
        row.note = "P1 is too stiff in bending";
    else
        bound(row, row.reference - 4.0 * nu * nu * depth_m / length_m * bending - shear_of_a_depth,
              row.reference + shear_of_a_depth,
              "solid against beam: 4 nu^2 h / L of the bending for the held anticlastic curvature, the shear "
              "deflection of one depth");
    return row;
}

}  // namespace gravity

VerificationRows gravity_cantilever_rows(const Effort& effort)
{
    using namespace gravity;
    return {row_of(effort, 1, 6), row_of(effort, 2, 4), row_of(effort, 2, 8)};
}

}  // namespace reference_fem
