// Another code's word on the same nodes, tets and data: CalculiX, whose C3D4 and C3D10 are P1 and P2. Both solve one and the same system,
// so whatever differs is an error of one of them or rounding.
//
//   cantilever  #|=====================| |    weight and end load, linear
//               #|=====================| v
//   limb         (---####---.---####---)      bones (####) hold whole tets; forearm bent or twisted, linear and large strain
//
// Besides, the first solve of the cantilever is timed on both sides. Without ccx on the PATH one row says so.
#include "experiments/studies/verification/problem.hpp"
#include "experiments/studies/verification/calculix/first_solve_timing.hpp"
#include "experiments/studies/verification/calculix/second_opinion.hpp"
#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

#include "pbs/character/character.hpp"

#include <cmath>
#include <limits>

namespace experiments {

using namespace reference_fem;

namespace {

constexpr reference_fem::ElasticMaterial flesh{.young_pa = 1e5, .poisson = 0.3};

// The condition number of the cantilever on the finest mesh, from its first bending mode (12.4 E I / L^3 over a third of its 16,393 nodes)
// against the stiffness of one edge (5 E h), is 2e7; sqrt(n) eps cond(K) = 5e-7. CalculiX stops Newton at 1e-9 of the mean force.
constexpr double most_difference = 1e-6;
const std::string most_difference_from =
    "rounding of a direct solve: sqrt(n) eps cond(K), cond(K) = 2e7 from the slowest mode of the longest cantilever";

struct Comparison {
    const Effort& effort;
    std::string program, version;
};

VerificationRow row_of(const Comparison& comparison, const std::string& quantity, const std::string& law, AnsweredProblem answer,
                       const DeckOptions& options)
{
    const int element_order = answer.problem.tets.cols() == 4 ? 1 : 2;
    answer.problem.material = flesh;  // whatever the judge was told
    VerificationRow row = {.problem = "calculix",
                           .quantity = "largest node difference over largest displacement, " + quantity,
                           .elements = elements_name(element_order),
                           .material = law + ", nu = 0.3",
                           .dofs = 3 * static_cast<int>(answer.problem.nodes.rows()),
                           .reference = 0.0,
                           .unit = "1",
                           .source = comparison.version + ", " + (element_order == 1 ? "C3D4" : "C3D10")};
    const SecondOpinion opinion = second_opinion(comparison.program, answer, options);
    row.value = answer.answered ? opinion.relative_difference() : std::numeric_limits<double>::quiet_NaN();
    row.high = most_difference;
    row.bound_from = most_difference_from;
    if (opinion.outcome != CalculixOutcome::finished) {
        row.value = std::numeric_limits<double>::quiet_NaN();
        row.note = std::string("CalculiX has no answer (") + name_of(opinion.outcome) + "): " + opinion.last_words;
    } else if (!opinion.in_double)
        row.note = "CalculiX's displacements to 7 digits only";
    return row;
}

LoadedCantilever cantilever_of(const Effort& effort)
{
    return {solver_material(effort, flesh), 1000.0, {0.0, 1e-3, -1e-2}, {0.3, 0.0, -0.5}};
}

VerificationRows cantilevers(const Comparison& comparison)
{
    VerificationRows rows;
    const Divisions divisions = {48, 6, 6};
    for (const int element_order : {1, 2}) {
        const pbs::TetMesh mesh = box_mesh({0, 0, 0}, {10, 1, 1}, divisions);
        rows.push_back(
            row_of(comparison, "cantilever", "linear", answered_cantilever(mesh, element_order, cantilever_of(comparison.effort)), {}));
        rows.back().mesh = text_of(divisions);
        rows.back().h_m = 1.0 / divisions[1];
    }
    return rows;
}

struct LimbPose {
    std::string name;
    pbs::Vec3 axis;
    double angle_deg;
    FrameModel model;
    int element_order;
};

VerificationRow limb_row(const Comparison& comparison, const pbs::Character& limb, const LimbPose& pose)
{
    const HeldFrame frame{solver_material(comparison.effort, flesh), 0.6, pose.model, [&](double fraction) {
                              return pbs::joint_sweep(limb.skeleton, 1, pose.axis, fraction * pose.angle_deg, 2, 0.01).steps.back();
                          }};
    const bool linear = pose.model == FrameModel::linear;
    DeckOptions options;
    options.analysis = linear ? CalculixAnalysis::linear : CalculixAnalysis::large_strain;
    VerificationRow row = row_of(comparison, "limb, " + pose.name, linear ? "linear" : "St Venant-Kirchhoff",
                                 answered_frame(limb, pose.element_order, frame), options);
    row.mesh = std::to_string(limb.mesh.rest.rows()) + " vertices";
    if (pose.model == FrameModel::st_venant_kirchhoff_at_four_points) row.note += "P2 integrated by C3D10's four points";
    if (pose.model == FrameModel::st_venant_kirchhoff && pose.element_order == 2) {
        row.high.reset();
        row.bound_from.clear();
        row.note += "six quadrature points against C3D10's four";
    }
    return row;
}

VerificationRows limbs(const Comparison& comparison)
{
    const pbs::Vec3 twist = pbs::Vec3::UnitX(), bend = pbs::Vec3::UnitZ();
    const pbs::Character limb = comparison.effort.limb(0, 0), coarse_limb = comparison.effort.limb(600, 0);
    VerificationRows rows;
    for (const int element_order : {1, 2}) {
        rows.push_back(limb_row(comparison, limb, {"bent by 10 deg", bend, 10.0, FrameModel::linear, element_order}));
        rows.push_back(limb_row(comparison, limb, {"bent by 90 deg", bend, 90.0, FrameModel::linear, element_order}));
        rows.push_back(limb_row(comparison, limb, {"twisted by 90 deg", twist, 90.0, FrameModel::linear, element_order}));
    }
    rows.push_back(limb_row(comparison, limb, {"bent by 30 deg", bend, 30.0, FrameModel::st_venant_kirchhoff, 1}));
    rows.push_back(limb_row(comparison, limb, {"twisted by 30 deg", twist, 30.0, FrameModel::st_venant_kirchhoff, 1}));
    const pbs::Character& second_order_limb = comparison.effort.full ? limb : coarse_limb;
    for (const FrameModel model : {FrameModel::st_venant_kirchhoff_at_four_points, FrameModel::st_venant_kirchhoff})
        rows.push_back(limb_row(comparison, second_order_limb, {"bent by 30 deg", bend, 30.0, model, 2}));
    return rows;
}

VerificationRows timing_rows(const Comparison& comparison)
{
    const Divisions divisions = {48, 6, 6};
    const FirstSolveTiming timing =
        time_first_solve(comparison.program, box_mesh({0, 0, 0}, {10, 1, 1}, divisions), 1, cantilever_of(comparison.effort), 9);
    const auto row = [&](const std::string& quantity, double value) {
        return VerificationRow{.problem = "calculix",
                               .quantity = quantity,
                               .elements = "P1",
                               .material = linear_material(flesh.poisson),
                               .mesh = text_of(divisions),
                               .h_m = 1.0 / divisions[1],
                               .dofs = timing.dofs,
                               .value = value,
                               .reference = 3.0,
                               .unit = "1",
                               .source = comparison.version + ", one thread, SPOOLES; processor time, the smallest of nine"};
    };
    const auto ms = [](double seconds) { return std::to_string(static_cast<int>(std::lround(1e3 * seconds))) + " ms"; };
    VerificationRow first = row("time of CalculiX over ours, first solve", timing.speedup());
    first.note = "wanted, and not judged, for machines are noisy: at least 3 times; ours, stiffness, load, analysis, factor and solve: " +
                 ms(timing.solve_s) + "; CalculiX, the whole process: " + ms(timing.calculix_s);
    VerificationRow with_elements = row("the same with our set-up of the elements", timing.speedup_with_elements());
    with_elements.note = "triangulation and numbering: " + ms(timing.elements_s);
    VerificationRow without_reading = row("the same without CalculiX's start and reading of the mesh", timing.speedup_without_reading());
    without_reading.note = "start and reading: " + ms(timing.reading_s);
    return {first, with_elements, without_reading};
}

}  // namespace

VerificationRows calculix_rows(const Effort& effort)
{
    const auto program = calculix_on_path();
    if (!program)
        return {{.problem = "calculix",
                 .quantity = "second opinion",
                 .unit = "1",
                 .note = "not installed: no ccx on the PATH (Debian: calculix-ccx)"}};
    const Comparison comparison{effort, *program, calculix_version(*program)};
    VerificationRows rows = cantilevers(comparison);
    const auto append = [&](const VerificationRows& more) { rows.insert(rows.end(), more.begin(), more.end()); };
    if (effort.limb) append(limbs(comparison));
    append(timing_rows(comparison));
    return rows;
}

}  // namespace experiments
