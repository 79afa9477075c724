// Lame's thick sphere, radii 1 and 2 m, under internal pressure; one octant, rollers on the planes of symmetry. The tets are straight,
// so the sphere is faceted: an error of order 2 in h for every element order.
// u_r = p a^3 / (E (b^3 - a^3)) ((1 - 2 nu) r + (1 + nu) b^3 / (2 r^2)) (Timoshenko and Goodier, Theory of elasticity, art. 136).
#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

namespace reference_fem {
namespace {

using pbs::Vec3;

constexpr double inner_m = 1.0, outer_m = 2.0, pressure_pa = 1.0;

// Three patches of n^3 cells that meet along the octant's middle.
pbs::TetMesh octant(int n)
{
    const pbs::TetMesh cube = box_mesh(Vec3::Zero(), Vec3::Ones(), {n, n, n});
    const auto patch = [&](auto direction) {
        return mapped(cube, [=](const Vec3& p) -> Vec3 { return (inner_m + (outer_m - inner_m) * p.z()) * direction(p).normalized(); });
    };
    return joined({patch([](const Vec3& p) { return Vec3(1.0, p.x(), p.y()); }),
                   patch([](const Vec3& p) { return Vec3(p.x(), 1.0, p.y()); }),
                   patch([](const Vec3& p) { return Vec3(p.x(), p.y(), 1.0); })});
}

double radial_displacement(const ElasticMaterial& material, double r)
{
    const double nu = material.poisson, a3 = std::pow(inner_m, 3), b3 = std::pow(outer_m, 3);
    return pressure_pa * a3 / (material.young_pa * (b3 - a3)) * ((1.0 - 2.0 * nu) * r + (1.0 + nu) * b3 / (2.0 * r * r));
}

VerificationRow row_of(const Effort& effort, double nu, int element_order, Formulation formulation, int n)
{
    const ElasticMaterial material{1.0, nu};
    const pbs::TetMesh mesh = octant(n);
    const BoundaryValueSolution solution =
        solve(mesh, solver_material(effort, material),
              {.held = [](const Vec3& x) { return Held(x.x() < 1e-9, x.y() < 1e-9, x.z() < 1e-9); },
               .element_order = element_order,
               .tractions = {{[](const Vec3& centre) { return centre.minCoeff() > 1e-9 && centre.norm() < (inner_m + outer_m) / 2.0; },
                              [](const Vec3&, const Vec3& normal) -> Vec3 { return -pressure_pa * normal; }}},
               .formulation = formulation});
    double sum = 0.0;
    int count = 0;
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) {
        if (mesh.rest.row(v).norm() > inner_m + 1e-9) continue;
        sum += solution.displacement.segment<3>(3 * v).dot(mesh.rest.row(v).transpose().normalized());
        ++count;
    }
    return {.problem = "thick_sphere",
            .quantity = {"inner_radial_displacement", "radial displacement of the inner surface"},
            .elements = elements_of(element_order, formulation),
            .material = linear_material(nu),
            .mesh = "3 x " + text_of({n, n, n}) + " in an octant",
            .h_m = (outer_m - inner_m) / n,
            .dofs = solution.space->dofs(),
            .value = sum / count,
            .reference = radial_displacement(material, inner_m),
            .unit = "m",
            .source = "closed form: G. Lame's thick sphere (Timoshenko and Goodier, Theory of elasticity, art. 136)"};
}

// Meshes of n, 2n, ... cells across.
VerificationRows ladder(const Effort& effort, double nu, int element_order, Formulation formulation, int coarsest, int levels)
{
    VerificationRows rows;
    for (int level = 0; level < levels; ++level) {
        rows.push_back(row_of(effort, nu, element_order, formulation, coarsest << level));
        if (level == 0) continue;
        const VerificationRow& coarser = rows[level - 1];
        rows.back().observed_order = order_between(coarser.value - coarser.reference, rows.back().value - rows.back().reference);
    }
    return rows;
}

void judge_as_second_order(VerificationRow& row)
{
    row.expected_order = 2.0;
    if (!row.bound_from.empty()) row.bound_from += "; ";
    row.bound_from += "order 2 of the faceted geometry within 0.1";
}

}  // namespace

VerificationRows thick_sphere_rows(const Effort& effort)
{
    const int coarsest = effort.full ? 6 : 4;
    VerificationRows rows;
    for (const double nu : {0.3, 0.499}) {
        VerificationRows linear = ladder(effort, nu, 1, Formulation::displacement, 4, 3);
        VerificationRows quadratic = ladder(effort, nu, 2, Formulation::displacement, coarsest, 2);
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
    VerificationRows taylor_hood = ladder(effort, 0.4999, 2, Formulation::taylor_hood, coarsest, 2);
    bound_by_grade_a(taylor_hood.back());
    judge_as_second_order(taylor_hood.back());
    rows.insert(rows.end(), taylor_hood.begin(), taylor_hood.end());
    return rows;
}

}  // namespace reference_fem
