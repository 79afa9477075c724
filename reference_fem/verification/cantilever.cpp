// A cantilever, 10 x 1 x 1 m, clamped whole at one end, a uniform shear traction of 1 N on the other.
//
//   #|========================|  | P      tip deflection = P L^3 / (3 E I) + P L / (k G A)
//   #|========================|  v        k = 10 (1 + nu) / (12 + 11 nu)
//
// The solid differs from the beam near its ends, over one depth by Saint-Venant's principle: a clamp that holds the anticlastic curvature
// bends as a plate there, 1 - nu^2 as much, and the first depth h of a tip-loaded cantilever makes 3 h / L of its deflection; at either
// end the warping of the cross-section may be free or held, which is at most the shear deflection of one depth.
#include "reference_fem/verification/beam_problems.hpp"

namespace reference_fem {
namespace {

using pbs::Vec3;

constexpr double length_m = 10.0, depth_m = 1.0, force_n = 1.0, young_pa = 1.0e5;

struct BeamTheory {
    double deflection_m, clamp_m, shear_m;  // the whole; what the clamp may take from it; the shear deflection of one depth
};

BeamTheory timoshenko(double nu)
{
    const double area = depth_m * depth_m, inertia = area * area / 12.0, shear_pa = young_pa / (2.0 * (1.0 + nu));
    const double k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
    const double bending = force_n * length_m * length_m * length_m / (3.0 * young_pa * inertia);
    return {bending + force_n * length_m / (k * shear_pa * area), 3.0 * nu * nu * depth_m / length_m * bending,
            force_n * depth_m / (k * shear_pa * area)};
}

}  // namespace

VerificationRow cantilever_row(const Effort& effort, double nu, int element_order, Formulation formulation, const Divisions& divisions)
{
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
    VerificationRow row = {.problem = "cantilever",
                           .quantity = {"tip_deflection", "tip deflection"},
                           .elements = elements_of(element_order, formulation),
                           .material = linear_material(nu),
                           .mesh = text_of(divisions),
                           .h_m = depth_m / divisions[1],
                           .dofs = solution.space->dofs(),
                           .value = solution.work_of_load_j() / force_n,
                           .reference = theory.deflection_m,
                           .unit = "m",
                           .source = "closed form: Timoshenko's beam, shear coefficient of G. R. Cowper, J. Appl. Mech. 33 (1966) 335-340"};
    if (element_order == 1) {
        row.note = "P1 is too stiff in bending; its convergence is judged by the manufactured solution";
        return row;
    }
    row.low = theory.deflection_m - theory.clamp_m - theory.shear_m;
    row.high = theory.deflection_m + theory.shear_m;
    row.bound_from =
        "solid against beam: 3 nu^2 h / L of the bending for the held anticlastic curvature, the shear deflection of one depth";
    return row;
}

VerificationRows cantilever_rows(const Effort& effort)
{
    VerificationRows rows;
    for (const double nu : {0.0, 0.3})
        for (const int element_order : {1, 2})
            for (const int n : {3, 6, 12})
                if (n < 12 || (effort.full && element_order == 1))
                    rows.push_back(cantilever_row(effort, nu, element_order, Formulation::displacement, {8 * n, n, n}));
    return rows;
}

}  // namespace reference_fem
