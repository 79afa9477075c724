#include "reference_fem/verification/calculix/calculix_rows.hpp"

#include "reference_fem/verification/calculix/loaded_cantilever.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

#include <cmath>
#include <limits>

namespace reference_fem {
namespace {

// The condition number of the cantilever on the finest mesh, from its first bending mode (12.4 E I / L^3 over a third of its 16,393 nodes)
// against the stiffness of one edge (5 E h), is 2e7; sqrt(n) eps cond(K) = 5e-7. CalculiX stops Newton at 1e-9 of the mean force.
constexpr double largest_difference = 1e-6;
const std::string largest_difference_from =
    "rounding of a direct solve: sqrt(n) eps cond(K), cond(K) = 2e7 from the slowest mode of the longest cantilever";
const Divisions divisions = {48, 6, 6};

pbs::TetMesh cantilever_mesh()
{
    return box_mesh({0, 0, 0}, {10, 1, 1}, divisions);
}

LoadedCantilever cantilever_of(const Effort& effort)
{
    return {solver_material(effort, calculix_flesh), 1000.0, {0.0, 1e-3, -1e-2}, {0.3, 0.0, -0.5}};
}

}  // namespace

VerificationRow calculix_row(const CalculixComparison& comparison, const std::string& pose, const std::string& law, AnsweredProblem answer,
                             const DeckOptions& options)
{
    const int element_order = answer.problem.tets.cols() == 4 ? 1 : 2;
    answer.problem.material = calculix_flesh;  // CalculiX has the right material, whatever error the effort asks of the reference
    VerificationRow row = {
        .problem = "calculix",
        .quantity = {"largest_node_difference", "largest node difference over largest displacement, " + pose, identifier_of(pose)},
        .elements = elements_of(element_order),
        .material = material_of(law, calculix_flesh.poisson),
        .dofs = 3 * static_cast<int>(answer.problem.nodes.rows()),
        .reference = 0.0,
        .unit = "1",
        .source = comparison.version + ", " + (element_order == 1 ? "C3D4" : "C3D10")};
    const SecondOpinion opinion = second_opinion(comparison.program, answer, options);
    row.value = answer.answered ? opinion.relative_difference() : std::numeric_limits<double>::quiet_NaN();
    row.high = largest_difference;
    row.bound_from = largest_difference_from;
    if (opinion.outcome != CalculixOutcome::finished) {
        row.value = std::numeric_limits<double>::quiet_NaN();
        row.note = std::string("CalculiX has no answer (") + name_of(opinion.outcome) + "): " + opinion.last_words;
    } else if (!opinion.in_double)
        row.note = "CalculiX's displacements to 7 digits only";
    return row;
}

VerificationRows calculix_cantilever_rows(const CalculixComparison& comparison)
{
    VerificationRows rows;
    for (const int element_order : {1, 2}) {
        const AnsweredProblem answer = answered_cantilever(cantilever_mesh(), element_order, cantilever_of(comparison.effort));
        rows.push_back(calculix_row(comparison, "cantilever", "linear", answer, {}));
        rows.back().mesh = text_of(divisions);
        rows.back().h_m = 1.0 / divisions[1];
    }
    return rows;
}

VerificationRows calculix_timing_rows(const CalculixComparison& comparison)
{
    const FirstSolveTiming timing = time_first_solve(comparison.program, cantilever_mesh(), 1, cantilever_of(comparison.effort), 9);
    const auto row = [&](const RowQuantity& quantity, double value, const std::string& note) {
        return VerificationRow{.problem = "calculix",
                               .quantity = quantity,
                               .elements = elements_of(1),
                               .material = linear_material(calculix_flesh.poisson),
                               .mesh = text_of(divisions),
                               .h_m = 1.0 / divisions[1],
                               .dofs = timing.dofs,
                               .value = value,
                               .reference = 3.0,
                               .unit = "1",
                               .source = comparison.version + ", one thread, SPOOLES; processor time, the smallest of nine",
                               .note = note};
    };
    const auto ms = [](double seconds) { return std::to_string(static_cast<int>(std::lround(1e3 * seconds))) + " ms"; };
    return {row({"time_ratio", "time of CalculiX over ours, first solve"}, timing.speedup(),
                "wanted, and not judged, for machines are noisy: at least 3 times; ours, stiffness, load, analysis, factor and solve: " +
                    ms(timing.solve_s) + "; CalculiX, the whole process: " + ms(timing.calculix_s)),
            row({"time_ratio_with_elements", "the same with our set-up of the elements"}, timing.speedup_with_elements(),
                "triangulation and numbering: " + ms(timing.elements_s)),
            row({"time_ratio_without_reading", "the same without CalculiX's start and reading of the mesh"},
                timing.speedup_without_reading(), "start and reading: " + ms(timing.reading_s))};
}

}  // namespace reference_fem
