// Two bodies that are pressed together by the contact of a surface with itself.

#include "reference_fem/contact/contact_potential.hpp"
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/verification/problems.hpp"

#include <cmath>

namespace reference_fem {
namespace {

using pbs::Vec3;

// Bodies in contact, some degrees of freedom prescribed, followed along a path from rest.
struct PressedBodies {
    PressedBodies(const Effort& effort, const pbs::TetMesh& mesh, int element_order, const ElasticMaterial& material,
                  const ContactOptions& contact_options, const BoundaryValueProblem& problem)
        : space(mesh, element_order),
          flesh(space, Model::neo_hookean, lame_of(solver_material(effort, material)), Formulation::displacement),
          contact(space, contact_options),
          displacement(Eigen::VectorXd::Zero(space.dofs()))
    {
        const PrescribedData data = prescribed_data(space, problem);
        NewtonMinimiser newton(space, data.held, LinearSolver::cholmod);
        path = follow_load_path(
            [&](double fraction) {
                return newton.minimise({&flesh, &contact}, fraction * data.values, displacement, {});
            },
            displacement, {.first_step = 1.0 / 4.0, .smallest_step = 1.0 / 1024.0});
    }

    static Lame lame_of(const ElasticMaterial& material)
    {
        return lame_parameters(material.young_pa, material.poisson);
    }

    // The force on the nodes at a height at rest, along z [N].
    double reaction_n(double height_m) const
    {
        Eigen::VectorXd force = Eigen::VectorXd::Zero(space.dofs());
        flesh.add_gradient(displacement, force);
        double sum = 0.0;
        for (int n = 0; n < space.nodes(); ++n)
            if (std::abs(space.node_positions()(n, 2) - height_m) < 1e-9) sum += force(3 * n + 2);
        return sum;
    }

    SimplexSpace space;
    ElasticPotential flesh;
    ContactPotential contact;
    Eigen::VectorXd displacement;
    LoadPathSummary path;
};

// Two cubes of 1 m, one above the other, nu = 0. The lower one stands on the floor, and the top of the upper one is
// pressed down by way_m beyond their gap. Nothing moves sideways, so that each is compressed to the length s with the
// pressure mu (1/s - s), and the gap d follows from the barrier: E |b'(d)| is that pressure. (Free to slide, they would
// buckle.)
namespace blocks {

constexpr double range_m = 1e-3, gap_m = 2.0 * range_m, way_m = 0.1, young_pa = 1e5;

struct Closed {
    double pressure_pa, gap_m;
};

// By bisection of the length s of a block: 2 s + d = 2 - way_m.
Closed closed_form()
{
    double low = 1.0 - way_m, high = 1.0;
    const auto pressure = [](double s) { return young_pa / 2.0 * (1.0 / s - s); };
    const auto gap_of = [](double pressure_pa) {
        double nearest = 0.0, farthest = range_m;
        for (int k = 0; k < 200; ++k) {
            const double middle = (nearest + farthest) / 2.0;
            (-young_pa * barrier(middle, range_m).first > pressure_pa ? nearest : farthest) = middle;
        }
        return nearest;
    };
    for (int k = 0; k < 200; ++k) {
        const double s = (low + high) / 2.0;
        (2.0 * s + gap_of(pressure(s)) < 2.0 - way_m ? low : high) = s;
    }
    return {pressure(low), gap_of(pressure(low))};
}

VerificationRow row_of(const Effort& effort, int element_order, int below, int above)
{
    const pbs::TetMesh mesh = joined({box_mesh({0, 0, 0}, {1, 1, 1}, {below, below, 2}),
                                      box_mesh({0, 0, 1 + gap_m}, {1, 1, 2 + gap_m}, {above, above, 2})});
    const PressedBodies bodies(
        effort, mesh, element_order, {young_pa, 0.0}, {.range_m = range_m, .stiffness_pa = young_pa},
        {.displacement = [](const Vec3& x) { return Vec3(0, 0, x.z() > 1.5 ? -gap_m - way_m : 0.0); },
         .held = [](const Vec3& x) { return Held(true, true, x.z() < 1e-9 || x.z() > 2 + gap_m - 1e-9); },
         .element_order = element_order});
    const double exact_pa = closed_form().pressure_pa;
    VerificationRow row = row_about({"contact", elements_of(element_order), material_of("neo_hookean", 0.0),
                                     text_of({below, below, 2}) + " on " + text_of({above, above, 2}),
                                     1.0 / std::max(below, above), bodies.space.dofs()},
                                    {"pressure_of_blocks", "pressure between two blocks"},
                                    bodies.path.converged() ? bodies.reaction_n(0.0) : not_reached, exact_pa, "Pa",
                                    "closed form: uniaxial compression and the barrier's own law");
    // Every gap is between 0 and the range, so that the blocks together are between 0 and one range too short: dp/ds =
    // -mu (1 + 1/s^2).
    const double s = 1.0 - way_m / 2.0, bound_pa = young_pa / 2.0 * (1.0 + 1.0 / (s * s)) * range_m / 2.0;
    bound(row, exact_pa - bound_pa, exact_pa + bound_pa,
          "the gap is at most the contact's range, wherever the rims of the blocks press");
    return row;
}

}  // namespace blocks

// Two equal spheres of radius R pressed together by the force F touch within the radius a = (3 F R* / (4 E*))^(1/3),
// with E* = E / (2 (1 - nu^2)) and R* = R / 2, under the pressure p0 sqrt(1 - r^2/a^2), whose mean of r^2 is 2 a^2 / 5
// (H. Hertz, 1881; K. Johnson, Contact mechanics, Cambridge 1985, Eqs. 4.22 to 4.24). A quarter of each: a block of
// side L whose top is a paraboloid, the sphere to first order. About half of the cells lie inside the contact, and
// cells grow beyond it: the cell of the rim is 0.51 a wide (5 cells) and 0.36 a (6 or 7 cells).
namespace spheres {

constexpr double radius_m = 1.0, side_m = 0.3, range_m = 1e-4, gap_m = 2.0 * range_m, young_pa = 1e5, poisson = 0.3,
                 approach_m = 4e-3;

constexpr double slope_at_pole = 0.3;  // width of the cell at the pole over that of equal cells

double graded(double p)
{
    return slope_at_pole * p + (1.0 - slope_at_pole) * std::pow(p, 7);
}

VerificationRow row_of(const Effort& effort, int element_order, int n)
{
    const auto cap = [](double side) {
        return [side](const Vec3& p) -> Vec3 {
            const double x = side_m * graded(p.x()), y = side_m * graded(p.y()), depth = p.z() * p.z();
            return {x, y, side * (gap_m / 2.0 + (x * x + y * y) / (2.0 * radius_m) * (1.0 - depth) + side_m * depth)};
        };
    };
    const pbs::TetMesh cube = box_mesh({0, 0, 0}, {1, 1, 1}, {n, n, n});
    const double end_m = side_m + gap_m / 2.0;
    const PressedBodies bodies(
        effort, joined({mapped(cube, cap(1.0)), mapped(cube, cap(-1.0))}), element_order, {young_pa, poisson},
        {.range_m = range_m, .stiffness_pa = young_pa},
        {.displacement = [](const Vec3& x) { return Vec3(0, 0, (x.z() > 0 ? -0.5 : 0.5) * (approach_m + gap_m)); },
         .held = [end_m](const Vec3& x) { return Held(x.x() < 1e-9, x.y() < 1e-9, std::abs(x.z()) > end_m - 1e-9); },
         .element_order = element_order});
    Eigen::VectorXd pressing = Eigen::VectorXd::Zero(bodies.space.dofs());
    bodies.contact.add_gradient(bodies.displacement, pressing);
    double force_n = 0.0, moment_nm2 = 0.0;  // on the upper body
    for (int node = 0; node < bodies.space.nodes(); ++node)
        if (const Vec3 at = bodies.space.node_positions().row(node); at.z() > 0.0) {
            force_n -= 4.0 * pressing(3 * node + 2);
            moment_nm2 -= 4.0 * pressing(3 * node + 2) * at.head<2>().squaredNorm();
        }
    const double modulus_pa = young_pa / (2.0 * (1.0 - poisson * poisson));
    VerificationRow row = row_about({"contact", elements_of(element_order), material_of("neo_hookean", poisson),
                                     text_of({n, n, n}), side_m * slope_at_pole / n, bodies.space.dofs()},
                                    {"radius_of_contact", "radius of the contact of two spheres"},
                                    bodies.path.converged() ? std::sqrt(2.5 * moment_nm2 / force_n) : not_reached,
                                    std::cbrt(3.0 * force_n * radius_m / 2.0 / (4.0 * modulus_pa)), "m",
                                    "H. Hertz, J. reine angew. Math. 92, 1881, for the force of the same solution");
    if (element_order == 2) bound_by_grade_a(row);
    return row;
}

}  // namespace spheres
}  // namespace

VerificationRows contact_rows(const Effort& effort)
{
    VerificationRows rows = {blocks::row_of(effort, 1, 2, 2), blocks::row_of(effort, 1, 3, 2),
                             blocks::row_of(effort, 2, 2, 3), spheres::row_of(effort, 1, 6),
                             spheres::row_of(effort, 2, 5)};
    if (effort.full)
        for (const int n : {6, 7}) rows.push_back(spheres::row_of(effort, 2, n));
    return rows;
}

}  // namespace reference_fem
