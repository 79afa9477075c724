// NAFEMS LE10: a quarter of a thick elliptic plate with an elliptic hole, 1 MPa of pressure on the top.
//
//   inner ellipse 2 x 1 m, outer 3.25 x 2.75 m, thickness 0.6 m; E = 210 GPa, nu = 0.3
//   held: u_y on y = 0, u_x on x = 0, u_x and u_y on the outer face, u_z on the middle of the outer face
//   asked for: sigma_yy at D = (2, 0, 0.6), on the hole's edge

#include "reference_fem/verification/problems.hpp"

#include <numbers>

namespace reference_fem {
namespace plate {

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
    // of an ellipse's (x/a)^2 + (y/b)^2, with room
    const double sagitta = std::pow(std::numbers::pi / 2.0 / divisions[1], 2) / 2.0;
    return std::pow(x.x() / 3.25, 2) + std::pow(x.y() / 2.75, 2) > 1.0 - sagitta;
}

VerificationRow row_of(const Effort& effort, int element_order, const Divisions& divisions)
{
    const auto held = [&](const Vec3& x) {
        const bool outer = on_outer_face(x, divisions);
        return Held(outer || std::abs(x.x()) < 1e-9, outer || std::abs(x.y()) < 1e-9,
                    outer && std::abs(x.z() - thickness_m / 2.0) < 1e-9);
    };
    const BoundaryValueSolution solution =
        solve(quarter_plate(divisions), solver_material(effort, material),
              {.held = held,
               .element_order = element_order,
               .tractions = {{[](const Vec3& centre) { return centre.z() > thickness_m - 1e-9; },
                              [](const Vec3&, const Vec3& normal) -> Vec3 { return -pressure_pa * normal; }}}});
    return row_about({"thick_plate", elements_of(element_order), linear_material(material.poisson), text_of(divisions),
                      thickness_m / divisions[2], solution.space->dofs()},
                     {"stress_yy_at_d", "sigma_yy at D"},
                     solution.stress_at({2.0, 0.0, thickness_m}, material)(1, 1) / 1e6, -5.38, "MPa",
                     "NAFEMS, The standard NAFEMS benchmarks, TNSB rev. 3, 1990, test LE10");
}

}  // namespace plate

VerificationRows thick_plate_rows(const Effort& effort)
{
    using namespace plate;
    VerificationRows rows = {row_of(effort, 1, {12, 16, 8}), row_of(effort, 2, {6, 8, 4}),
                             row_of(effort, 2, {12, 16, 8})};
    if (effort.full) rows.push_back(row_of(effort, 2, {18, 24, 12}));
    bound_by_grade_a(rows.back());
    return rows;
}

// Lame's thick sphere, radii 1 and 2 m, under internal pressure; one octant, rollers on the planes of symmetry. The
// tets are straight, so the sphere is faceted: an error of order 2 in h for every element order. u_r = p a^3 / (E (b^3
// - a^3)) ((1 - 2 nu) r + (1 + nu) b^3 / (2 r^2)) (Timoshenko and Goodier, Theory of elasticity, art. 136).

namespace sphere {

using pbs::Vec3;

constexpr double inner_m = 1.0, outer_m = 2.0, pressure_pa = 1.0;

// Three patches of n^3 cells that meet along the octant's middle.
pbs::TetMesh octant(int n)
{
    const pbs::TetMesh cube = box_mesh(Vec3::Zero(), Vec3::Ones(), {n, n, n});
    const auto patch = [&](auto direction) {
        return mapped(cube, [=](const Vec3& p) -> Vec3 {
            return (inner_m + (outer_m - inner_m) * p.z()) * direction(p).normalized();
        });
    };
    return joined({patch([](const Vec3& p) { return Vec3(1.0, p.x(), p.y()); }),
                   patch([](const Vec3& p) { return Vec3(p.x(), 1.0, p.y()); }),
                   patch([](const Vec3& p) { return Vec3(p.x(), p.y(), 1.0); })});
}

double radial_displacement(const ElasticMaterial& material, double r)
{
    const double nu = material.poisson, a3 = std::pow(inner_m, 3), b3 = std::pow(outer_m, 3);
    return pressure_pa * a3 / (material.young_pa * (b3 - a3)) *
           ((1.0 - 2.0 * nu) * r + (1.0 + nu) * b3 / (2.0 * r * r));
}

VerificationRow row_of(const Effort& effort, double nu, int element_order, Formulation formulation, int n)
{
    const ElasticMaterial material{1.0, nu};
    const pbs::TetMesh mesh = octant(n);
    const BoundaryValueSolution solution =
        solve(mesh, solver_material(effort, material),
              {.held = [](const Vec3& x) { return Held(x.x() < 1e-9, x.y() < 1e-9, x.z() < 1e-9); },
               .element_order = element_order,
               .tractions = {{[](const Vec3& centre) {
                                  return centre.minCoeff() > 1e-9 && centre.norm() < (inner_m + outer_m) / 2.0;
                              },
                              [](const Vec3&, const Vec3& normal) -> Vec3 { return -pressure_pa * normal; }}},
               .formulation = formulation});
    double sum = 0.0;
    int count = 0;
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) {
        if (mesh.rest.row(v).norm() > inner_m + 1e-9) continue;
        sum += solution.displacement.segment<3>(3 * v).dot(mesh.rest.row(v).transpose().normalized());
        ++count;
    }
    return row_about({"thick_sphere", elements_of(element_order, formulation), linear_material(nu),
                      "3 x " + text_of({n, n, n}) + " in an octant", (outer_m - inner_m) / n, solution.space->dofs()},
                     {"inner_radial_displacement", "radial displacement of the inner surface"}, sum / count,
                     radial_displacement(material, inner_m), "m",
                     "closed form: G. Lame's thick sphere (Timoshenko and Goodier, Theory of elasticity, art. 136)");
}

void judge_as_second_order(VerificationRow& row)
{
    row.expected_order = 2.0;
    if (!row.bound_from.empty()) row.bound_from += "; ";
    row.bound_from += "order 2 of the faceted geometry within 0.1";
}

}  // namespace sphere

VerificationRows thick_sphere_rows(const Effort& effort)
{
    using namespace sphere;
    const int coarsest = effort.full ? 6 : 4;
    const auto ladder_of = [&](double nu, int element_order, Formulation formulation, int coarsest_mesh, int levels) {
        return ladder([&](int n) { return row_of(effort, nu, element_order, formulation, n); }, coarsest_mesh, levels);
    };
    VerificationRows rows;
    for (const double nu : {0.3, 0.499}) {
        VerificationRows linear = ladder_of(nu, 1, Formulation::displacement, 4, 3);
        VerificationRows quadratic = ladder_of(nu, 2, Formulation::displacement, coarsest, 2);
        bound_by_grade_a(quadratic.back());
        if (nu < 0.4) {
            judge_as_second_order(linear.back());
            judge_as_second_order(quadratic.back());
        } else {
            linear.back().note = "P1 locks as nu goes to 1/2";
        }
        rows.insert(rows.end(), linear.begin(), linear.end());
        rows.insert(rows.end(), quadratic.begin(), quadratic.end());
    }
    VerificationRows taylor_hood = ladder_of(0.4999, 2, Formulation::taylor_hood, coarsest, 2);
    bound_by_grade_a(taylor_hood.back());
    judge_as_second_order(taylor_hood.back());
    rows.insert(rows.end(), taylor_hood.begin(), taylor_hood.end());
    return rows;
}

}  // namespace reference_fem
