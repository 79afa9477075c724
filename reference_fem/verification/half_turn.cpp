// A bar of 3.375 x 1 x 1 m, 27 x 8 x 8 cells, both ends held, one turned by 180 degrees in ten steps, in linear tets: Newton's iterations
// and the states that it finds by each law, against an earlier implementation of ours with an assembly and a Newton loop of its own.
// Large rotations distinguish the laws: linear strain takes them for a swelling of 31 % at 90 degrees and turns tets inside out, St
// Venant-Kirchhoff gives way.
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/potentials/elastic_potential.hpp"
#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace reference_fem {
namespace {

const Divisions divisions = {27, 8, 8};
constexpr double length_m = 3.375, young_pa = 1e5;
constexpr int steps = 10;
const std::string source =
    "our earlier implementation of the same laws and tets, with an assembly and a Newton loop of its own: regression, no outside truth";

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

bool at_far_end(const SimplexSpace& space, int node)
{
    return space.node_positions()(node, 0) > length_m - 1e-9;
}

std::vector<bool> held_ends(const SimplexSpace& space)
{
    std::vector<bool> held(space.dofs(), false);
    for (int node = 0; node < space.nodes(); ++node)
        for (int c = 0; c < 3; ++c) held[3 * node + c] = at_far_end(space, node) || space.node_positions()(node, 0) < 1e-9;
    return held;
}

Eigen::VectorXd turned_end(const SimplexSpace& space, double angle)
{
    Eigen::VectorXd values = Eigen::VectorXd::Zero(space.dofs());
    for (int node = 0; node < space.nodes(); ++node) {
        if (!at_far_end(space, node)) continue;
        const double y = space.node_positions()(node, 1), z = space.node_positions()(node, 2);
        values.segment<3>(3 * node) << 0.0, std::cos(angle) * y - std::sin(angle) * z - y, std::sin(angle) * y + std::cos(angle) * z - z;
    }
    return values;
}

// Not a number from the step on that did not converge.
TurnValues turn(const SimplexSpace& space, const ElasticPotential& flesh)
{
    NewtonMinimiser newton(space, held_ends(space), LinearSolver::cholmod);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    const auto volume_change_pct = [&] { return 100.0 * (flesh.jacobians(displacement).volume / length_m - 1.0); };
    const double none = std::numeric_limits<double>::quiet_NaN();
    TurnValues turned{0.0, none, none, none};
    for (int step = 1; step <= steps; ++step) {
        const NewtonSummary summary = newton.minimise({&flesh}, turned_end(space, std::numbers::pi * step / steps), displacement, {});
        if (!summary.converged()) return turned;
        turned.iterations += summary.steps();
        if (2 * step == steps) turned.volume_change_at_90_pct = volume_change_pct();
    }
    turned.volume_change_at_180_pct = volume_change_pct();
    turned.energy_j = flesh.value(displacement);
    return turned;
}

VerificationRow row_of(const Law& law, const RowQuantity& quantity, const std::string& unit, double value, double reference)
{
    constexpr double same = 1e-6;  // both stop at forces of 1e-8, Newton's last step being quadratic
    return {.problem = "half_turn",
            .quantity = quantity,
            .elements = elements_of(1),
            .material = material_of(law.name, law.poisson),
            .mesh = text_of(divisions),
            .h_m = length_m / divisions[0],
            .value = value,
            .reference = reference,
            .unit = unit,
            .source = source,
            .low = reference - same * std::abs(reference),
            .high = reference + same * std::abs(reference),
            .bound_from = "the same discrete problem: 1e-6 of the value, for both stop at a residual of 1e-8 of the forces"};
}

VerificationRows rows_of(const Effort& effort, const SimplexSpace& space, const Law& law)
{
    const ElasticMaterial material = solver_material(effort, {young_pa, law.poisson});
    const TurnValues ours =
        turn(space, ElasticPotential(space, law.model, lame_parameters(material.young_pa, material.poisson), Formulation::displacement));
    VerificationRow iterations =
        row_of(law, {"newton_iterations", "Newton iterations of ten steps to 180 degrees"}, "1", ours.iterations, law.reference.iterations);
    iterations.low = 1.0;
    iterations.high = 1.5 * law.reference.iterations;
    iterations.bound_from = "at most 1.5 times the other implementation's";
    VerificationRows rows = {
        iterations,
        row_of(law, {"volume_change_at_90_deg", "volume change at 90 degrees"}, "%", ours.volume_change_at_90_pct,
               law.reference.volume_change_at_90_pct),
        row_of(law, {"volume_change_at_180_deg", "volume change at 180 degrees"}, "%", ours.volume_change_at_180_pct,
               law.reference.volume_change_at_180_pct),
        row_of(law, {"strain_energy_at_180_deg", "strain energy at 180 degrees"}, "J", ours.energy_j, law.reference.energy_j)};
    for (VerificationRow& row : rows) row.dofs = space.dofs();
    return rows;
}

}  // namespace

VerificationRows half_turn_rows(const Effort& effort)
{
    const SimplexSpace space(box_mesh({0, -0.5, -0.5}, {length_m, 0.5, 0.5}, divisions), 1);
    VerificationRows rows;
    for (const Law& law : laws) {
        const bool is_quick = law.model == Model::linear || (law.model == Model::stable_neo_hookean && law.poisson != 0.45);
        if (!effort.full && !is_quick) continue;
        for (const VerificationRow& row : rows_of(effort, space, law)) rows.push_back(row);
    }
    return rows;
}

}  // namespace reference_fem
