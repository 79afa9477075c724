// A soft cantilever, 0.6 x 0.12 x 0.12 m, under its own weight: E = 1 MPa, nu = 0.3, 1000 kg/m^3, of the size and stiffness of flesh.
// w = weight per length; deflection = w L^4 / (8 E I) + w L^2 / (2 k G A). Near the clamp the solid differs from the beam as in
// cantilever.cpp; the first depth h makes 4 h / L of the bending deflection here.
#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

namespace reference_fem {
namespace {

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
    const double weight_n_m = density_kg_m3 * gravity_m_s2 * area, k_g_a = 10.0 * material.young_pa / (2.0 * (12.0 + 11.0 * nu)) * area;
    const double bending = weight_n_m * std::pow(length_m, 4) / (8.0 * material.young_pa * inertia);
    const double shear = weight_n_m * length_m * length_m / (2.0 * k_g_a);
    VerificationRow row = {.problem = "gravity_cantilever",
                           .quantity = {"end_deflection", "deflection of the end's middle"},
                           .elements = elements_of(element_order),
                           .material = linear_material(nu),
                           .mesh = text_of(divisions),
                           .h_m = depth_m / n,
                           .dofs = solution.space->dofs(),
                           .value = -solution.displacement_at({length_m, depth_m / 2.0, depth_m / 2.0}).z(),
                           .reference = bending + shear,
                           .unit = "m",
                           .source =
                               "closed form: Timoshenko's beam under uniform load, shear coefficient of G. R. Cowper, J. Appl. Mech. 33 "
                               "(1966) 335-340"};
    if (element_order == 1) {
        row.note = "P1 is too stiff in bending";
        return row;
    }
    const double shear_of_a_depth = weight_n_m * length_m * depth_m / k_g_a;
    row.low = row.reference - 4.0 * nu * nu * depth_m / length_m * bending - shear_of_a_depth;
    row.high = row.reference + shear_of_a_depth;
    row.bound_from =
        "solid against beam: 4 nu^2 h / L of the bending for the held anticlastic curvature, the shear deflection of one depth";
    return row;
}

}  // namespace

VerificationRows gravity_cantilever_rows(const Effort& effort)
{
    return {row_of(effort, 1, 6), row_of(effort, 2, 4), row_of(effort, 2, 8)};
}

}  // namespace reference_fem
