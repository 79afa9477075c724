// NAFEMS LE10: a quarter of a thick elliptic plate with an elliptic hole, 1 MPa of pressure on the top.
//
//   inner ellipse 2 x 1 m, outer 3.25 x 2.75 m, thickness 0.6 m; E = 210 GPa, nu = 0.3
//   held: u_y on y = 0, u_x on x = 0, u_x and u_y on the outer face, u_z on the middle of the outer face
//   asked for: sigma_yy at D = (2, 0, 0.6), on the hole's edge
#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

#include <cmath>
#include <numbers>

namespace reference_fem {
namespace {

using pbs::Vec3;

constexpr double thickness_m = 0.6, pressure_pa = 1.0e6;
const ElasticMaterial material{210.0e9, 0.3};

// Cells graded towards the hole, their first size along the radius 0.4 of the even one.
pbs::TetMesh quarter_plate(const Divisions& divisions)
{
    return mapped(box_mesh({0, 0, 0}, {1, 1, thickness_m}, divisions), [](const Vec3& p) -> Vec3 {
        const double s = 0.6 * p.x() * p.x() + 0.4 * p.x(), angle = std::numbers::pi / 2.0 * p.y();
        return {((1.0 - s) * 2.0 + s * 3.25) * std::cos(angle), ((1.0 - s) * 1.0 + s * 2.75) * std::sin(angle), p.z()};
    });
}

// Mid-edge nodes of straight tets lie inside the ellipse by up to the sagitta of a chord.
bool on_outer_face(const Vec3& x, const Divisions& divisions)
{
    const double sagitta = std::pow(std::numbers::pi / 2.0 / divisions[1], 2) / 2.0;  // of an ellipse's (x/a)^2 + (y/b)^2, with room
    return std::pow(x.x() / 3.25, 2) + std::pow(x.y() / 2.75, 2) > 1.0 - sagitta;
}

VerificationRow row_of(const Effort& effort, int element_order, const Divisions& divisions)
{
    const auto held = [&](const Vec3& x) {
        const bool outer = on_outer_face(x, divisions);
        return Held(outer || std::abs(x.x()) < 1e-9, outer || std::abs(x.y()) < 1e-9, outer && std::abs(x.z() - thickness_m / 2.0) < 1e-9);
    };
    const BoundaryValueSolution solution =
        solve(quarter_plate(divisions), solver_material(effort, material),
              {.held = held,
               .element_order = element_order,
               .tractions = {{[](const Vec3& centre) { return centre.z() > thickness_m - 1e-9; },
                              [](const Vec3&, const Vec3& normal) -> Vec3 { return -pressure_pa * normal; }}}});
    return {.problem = "thick_plate",
            .quantity = {"stress_yy_at_d", "sigma_yy at D"},
            .elements = elements_of(element_order),
            .material = linear_material(material.poisson),
            .mesh = text_of(divisions),
            .h_m = thickness_m / divisions[2],
            .dofs = solution.space->dofs(),
            .value = solution.stress_at({2.0, 0.0, thickness_m}, material)(1, 1) / 1e6,
            .reference = -5.38,
            .unit = "MPa",
            .source = "NAFEMS, The standard NAFEMS benchmarks, TNSB rev. 3, 1990, test LE10"};
}

}  // namespace

VerificationRows thick_plate_rows(const Effort& effort)
{
    VerificationRows rows = {row_of(effort, 1, {12, 16, 8}), row_of(effort, 2, {6, 8, 4}), row_of(effort, 2, {12, 16, 8})};
    if (effort.full) rows.push_back(row_of(effort, 2, {18, 24, 12}));
    bound_by_grade_a(rows.back());
    return rows;
}

}  // namespace reference_fem
