// Three problems of bars whose ends are turned against each other:
//   torsion       a small turn of linear flesh, compared with Saint-Venant's exact solution
//   twisted_beam  MacNeal and Harder's beam, which is turned by 90 degrees at rest and bent by a load at its tip
//   half_turn     a turn of 180 degrees with each law, compared with an earlier implementation

#include "reference_fem/newton/newton.hpp"
#include "reference_fem/potentials/potentials.hpp"
#include "reference_fem/verification/problems.hpp"

#include <fmt/format.h>

#include <numbers>

namespace reference_fem {

// A square bar whose ends turn against each other and are free to warp. Saint-Venant's torsion is the exact solution in
// three dimensions (Timoshenko and Goodier, Theory of elasticity, art. 109):
//   torque = G J theta / L,   J = s^4 / 3 (1 - 192 / pi^5 sum over odd n of tanh(n pi / 2) / n^5).
// The data are displacements, so that the strain energy and therefore the torque converge from above, with twice the
// order of the displacement gradient.

namespace torsion {

using pbs::Vec3;

constexpr double length_m = 1.0;
constexpr double side_m = 1.0;
constexpr double angle_rad = 1.0e-3;
constexpr double young_pa = 1.0e5;

// J [m^4]
double torsion_constant()
{
    double sum = 0.0;
    for (int n = 1; n <= 201; n += 2) sum += std::tanh(n * std::numbers::pi / 2.0) / std::pow(n, 5);
    return std::pow(side_m, 4) / 3.0 * (1.0 - 192.0 / std::pow(std::numbers::pi, 5) * sum);
}

}  // namespace torsion

VerificationRow torsion_row(const Effort& effort, double nu, int element_order, Formulation formulation, int n)
{
    using namespace torsion;
    const ElasticMaterial material{young_pa, nu};
    const auto displacement = [](const Vec3& x) -> Vec3 {
        return angle_rad * x.x() / length_m * Vec3(0.0, -x.z(), x.y());
    };
    const auto held = [](const Vec3& x) {
        const bool at_end = x.x() < 1e-9 || x.x() > length_m - 1e-9;
        return Held(x.norm() < 1e-9, at_end, at_end);  // one point keeps the bar from sliding along its axis
    };
    const ElasticMaterial material_of_solver = solver_material(effort, material);
    const pbs::TetMesh bar =
        box_mesh({0, -side_m / 2.0, -side_m / 2.0}, {length_m, side_m / 2.0, side_m / 2.0}, {n, n, n});
    const BoundaryValueSolution solution =
        solve(bar, material_of_solver,
              {.displacement = displacement, .held = held, .element_order = element_order, .formulation = formulation});
    const double shear_pa = young_pa / (2.0 * (1.0 + nu));
    return row_about({"torsion", elements_of(element_order, formulation), linear_material(nu), text_of({n, n, n}),
                      side_m / n, solution.space->dofs()},
                     {"torque", "torque"}, 2.0 * solution.strain_energy_j(material_of_solver) / angle_rad,
                     shear_pa * torsion_constant() * angle_rad / length_m, "N m",
                     "closed form: Saint-Venant's series (Timoshenko and Goodier, Theory of elasticity, art. 109)");
}

namespace torsion {

// Meshes of coarsest, 2 coarsest, ... cells along each edge. The finest one has a bound or an expected order.
VerificationRows bounded_ladder(const Effort& effort, int element_order, int coarsest, int levels)
{
    const auto row_of = [&](int n) { return torsion_row(effort, 0.3, element_order, Formulation::displacement, n); };
    VerificationRows rows = ladder(row_of, coarsest, levels);
    VerificationRow& finest = rows.back();
    finest.low = finest.reference * (1.0 - 1e-9);
    if (element_order == 1) {
        finest.expected_order = 2.0;
        finest.bound_from = "from above, as displacements are the data; order 2 of the energy within 0.1";
    } else {
        finest.high = finest.reference * (1.0 + grade_a);
        finest.bound_from = "from above, as displacements are the data; " + grade_a_text;
        finest.note =
            "the warping is as r^2 ln r at the edges, so the energy's order 4 is approached with the logarithm of h";
    }
    return rows;
}

}  // namespace torsion

VerificationRows torsion_rows(const Effort& effort)
{
    using namespace torsion;
    VerificationRows rows = bounded_ladder(effort, 1, 4, effort.full ? 4 : 3);
    for (const auto& row : bounded_ladder(effort, 2, 2, effort.full ? 4 : 3)) rows.push_back(row);
    return rows;
}

// MacNeal and Harder's twisted beam: 12 x 1.1 x 0.32 in, turned by 90 degrees from the clamp to the tip, E = 29e6 psi,
// nu = 0.22, a unit load at the tip. At the clamp the width lies along y, at the tip along z. A load along z lies in
// the plane of the tip's width and bends the beam about its thin side where the moment is largest: the large
// deflection; a load along y is out of that plane.
//
// Beam theory alone determines which of the two published values belongs to which load. It gives the deflection as P /
// E times the integral of s^2 (cos^2 phi / I_width + sin^2 phi / I_thickness). Here s is the distance to the tip, and
// phi is the angle between the load and the width.

namespace twisted_beam {

using pbs::Vec3;

constexpr double length_in = 12.0;
constexpr double width_in = 1.1;
constexpr double thickness_in = 0.32;
const ElasticMaterial material{29.0e6, 0.22};  // [psi]

// The angle by which the section at x [in] is turned at rest [rad].
double turn_rad(double x)
{
    return std::numbers::pi / 2.0 * x / length_in;
}

pbs::TetMesh beam(const Divisions& divisions)
{
    return mapped(
        box_mesh({0, -width_in / 2.0, -thickness_in / 2.0}, {length_in, width_in / 2.0, thickness_in / 2.0}, divisions),
        [](const Vec3& p) -> Vec3 {
            const double c = std::cos(turn_rad(p.x()));
            const double s = std::sin(turn_rad(p.x()));
            return {p.x(), c * p.y() - s * p.z(), s * p.y() + c * p.z()};
        });
}

// The tip deflection by bending alone [in], integrated by Simpson's rule. load: a unit vector [lbf].
double deflection_of_beam_in(const Vec3& load)
{
    const double moment_of_width = thickness_in * std::pow(width_in, 3) / 12.0;      // I_width [in^4]
    const double moment_of_thickness = width_in * std::pow(thickness_in, 3) / 12.0;  // I_thickness [in^4]
    const auto integrand = [&](double x) {
        const Vec3 width(0.0, std::cos(turn_rad(x)), std::sin(turn_rad(x)));
        const double cos2_phi = std::pow(load.dot(width), 2);
        return std::pow(length_in - x, 2) * (cos2_phi / moment_of_width + (1.0 - cos2_phi) / moment_of_thickness) /
               material.young_pa;
    };
    const int n = 200;
    double sum = integrand(0.0) + integrand(length_in);
    for (int i = 1; i < n; ++i) sum += (i % 2 ? 4.0 : 2.0) * integrand(length_in * i / n);
    return sum * length_in / (3.0 * n);
}

VerificationRow row_of(const Effort& effort, const Vec3& load, int element_order, const Divisions& divisions)
{
    const BoundaryValueSolution solution =
        solve(beam(divisions), solver_material(effort, material),
              {.held = [](const Vec3& x) { return x.x() < 1e-9; },
               .element_order = element_order,
               .tractions = {{[](const Vec3& centre) { return centre.x() > length_in - 1e-6; },
                              [&](const Vec3&, const Vec3&) -> Vec3 { return load / (width_in * thickness_in); }}}});
    const bool in_plane = load.z() != 0.0;
    VerificationRow row = row_about(
        {"twisted_beam", elements_of(element_order), linear_material(material.poisson), text_of(divisions),
         width_in / divisions[1] * 0.0254, solution.space->dofs()},
        in_plane
            ? RowQuantity{"tip_deflection_in_plane", "tip deflection, load along the tip's width (in plane)"}
            : RowQuantity{"tip_deflection_out_of_plane", "tip deflection, load across the tip's width (out of plane)"},
        solution.work_of_load_j(), in_plane ? 0.005424 : 0.001754, "in",
        "R. MacNeal, R. Harder, Finite Elements in Analysis and Design 1 (1985) 3-20, Table 7");
    row.note = fmt::format("beam theory, bending alone: {:.6f} in", deflection_of_beam_in(load));
    return row;
}

}  // namespace twisted_beam

VerificationRows twisted_beam_rows(const Effort& effort)
{
    using namespace twisted_beam;
    VerificationRows rows;
    for (const Vec3& load : {Vec3(0, 0, 1), Vec3(0, 1, 0)}) {
        rows.push_back(row_of(effort, load, 1, {48, 8, 4}));
        rows.push_back(row_of(effort, load, 2, {24, 4, 2}));
        bound_by_grade_a(rows.back());
        if (!effort.full) continue;
        rows.push_back(row_of(effort, load, 2, {48, 8, 4}));
        bound_by_grade_a(rows.back());
    }
    return rows;
}

// A bar of 3.375 x 1 x 1 m in linear tets, 27 x 8 x 8 cells, whose ends are held and of which one is turned by 180
// degrees in ten steps. Newton's iterations and the states that it finds by each law are compared with an earlier
// implementation of ours, which has an assembly and a Newton loop of its own. Large rotations distinguish the laws:
// linear strain takes them for a swelling of 31 % at 90 degrees and turns tets inside out, and St Venant-Kirchhoff
// gives way.

namespace half_turn {

using pbs::Vec3;

const Divisions divisions = {27, 8, 8};
constexpr double length_m = 3.375;
constexpr double young_pa = 1e5;
constexpr int steps = 10;
const std::string source =
    "our earlier implementation of the same laws and tets, with an assembly and a Newton loop of its own: regression, "
    "no outside truth";

struct TurnValues {
    double iterations;                                         // of all steps
    double volume_change_at_90_pct, volume_change_at_180_pct;  // 100 (V - V0) / V0
    double energy_j;                                           // at 180 degrees
};

struct Law {
    Model model;
    std::string name;
    double poisson;
    TurnValues reference;
};

const std::vector<Law> laws = {
    {Model::stable_neo_hookean, "stable_neo_hookean", 0.3, {50, -0.54875601453, -2.2862093441, 8.764288341984e3}},
    {Model::stable_neo_hookean, "stable_neo_hookean", 0.45, {52, -0.14701254924, -0.61770920955, 8.047671776187e3}},
    {Model::stable_neo_hookean, "stable_neo_hookean", 0.49, {60, -0.031776708163, -0.13479810078, 8.058009117295e3}},
    {Model::neo_hookean, "neo_hookean", 0.3, {50, -0.53699726800, -2.1441996139, 8.768634425136e3}},
    {Model::corotational, "corotational", 0.3, {50, -1.1677960915, -4.5892346582, 8.709920258043e3}},
    {Model::st_venant_kirchhoff, "st_venant_kirchhoff", 0.3, {50, -2.1304995670, -8.4372925420, 8.902397719894e3}},
    {Model::linear, "linear", 0.3, {10, 30.753109139, -4.8410438713, 8.406643111517e4}}};

// Both ends are held, the one at x = 0 at rest.
PrescribedData turned_end(const SimplexSpace& space, double angle_rad)
{
    const auto displacement = [angle_rad](const Vec3& x) -> Vec3 {
        if (x.x() < length_m - 1e-9) return Vec3::Zero();
        const double c = std::cos(angle_rad);
        const double s = std::sin(angle_rad);
        return {0.0, c * x.y() - s * x.z() - x.y(), s * x.y() + c * x.z() - x.z()};
    };
    const auto held = [](const Vec3& x) { return x.x() < 1e-9 || x.x() > length_m - 1e-9; };
    return prescribed_data(space, {.displacement = displacement, .held = held});
}

// Turns the end in ten steps. Values are not a number from the step on that did not converge.
TurnValues values_of_turn(const SimplexSpace& space, const ElasticPotential& flesh)
{
    NewtonMinimiser newton(space, turned_end(space, 0.0).held, LinearSolver::cholmod);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    const auto volume_change_pct = [&] { return 100.0 * (flesh.jacobians(displacement).volume / length_m - 1.0); };
    TurnValues values{0.0, not_reached, not_reached, not_reached};
    for (int step = 1; step <= steps; ++step) {
        const NewtonSummary summary =
            newton.minimise({&flesh}, turned_end(space, std::numbers::pi * step / steps).values, displacement, {});
        if (!summary.converged()) return values;
        values.iterations += summary.steps();
        if (2 * step == steps) values.volume_change_at_90_pct = volume_change_pct();
    }
    values.volume_change_at_180_pct = volume_change_pct();
    values.energy_j = flesh.value(displacement);
    return values;
}

struct TurnQuantity {
    RowQuantity quantity;
    std::string unit;
    double TurnValues::*value;
};
const std::vector<TurnQuantity> quantities = {
    {{"newton_iterations", "Newton iterations of ten steps to 180 degrees"}, "1", &TurnValues::iterations},
    {{"volume_change_at_90_deg", "volume change at 90 degrees"}, "%", &TurnValues::volume_change_at_90_pct},
    {{"volume_change_at_180_deg", "volume change at 180 degrees"}, "%", &TurnValues::volume_change_at_180_pct},
    {{"strain_energy_at_180_deg", "strain energy at 180 degrees"}, "J", &TurnValues::energy_j}};

VerificationRows rows_of(const Effort& effort, const SimplexSpace& space, const Law& law)
{
    const ElasticMaterial material = solver_material(effort, {young_pa, law.poisson});
    const ElasticPotential flesh(space, law.model, lame_parameters(material.young_pa, material.poisson),
                                 Formulation::displacement);
    const TurnValues values = values_of_turn(space, flesh);
    const RowSolution solution{"half_turn",        elements_of(1),          material_of(law.name, law.poisson),
                               text_of(divisions), length_m / divisions[0], space.dofs()};
    VerificationRows rows;
    for (const auto& [quantity, unit, value] : quantities) {
        const double reference = law.reference.*value;
        // Both programs stop at forces of 1e-8, and the last step of Newton's method converges quadratically.
        const double tolerance = 1e-6 * std::abs(reference);
        rows.push_back(row_about(solution, quantity, values.*value, reference, unit, source));
        bound(rows.back(), reference - tolerance, reference + tolerance,
              "the same discrete problem: 1e-6 of the value, for both stop at a residual of 1e-8 of the forces");
    }
    bound(rows.front(), 1.0, 1.5 * law.reference.iterations, "at most 1.5 times the other implementation's");
    return rows;
}

}  // namespace half_turn

VerificationRows half_turn_rows(const Effort& effort)
{
    using namespace half_turn;
    const SimplexSpace space(box_mesh({0, -0.5, -0.5}, {length_m, 0.5, 0.5}, divisions), 1);
    VerificationRows rows;
    for (const Law& law : laws) {
        const bool is_quick =
            law.model == Model::linear || (law.model == Model::stable_neo_hookean && law.poisson != 0.45);
        if (!effort.full && !is_quick) continue;
        for (const VerificationRow& row : rows_of(effort, space, law)) rows.push_back(row);
    }
    return rows;
}

}  // namespace reference_fem
