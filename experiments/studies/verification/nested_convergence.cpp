// The order and the bound of a reference from nested solutions, on flesh with smooth springs whose exact solution is
// known: linear and quadratic elements on some tets and on these tets cut into eight, as PosedReference solves them.

#include "analysis/statistics/grid_convergence.hpp"
#include "experiments/studies/verification/problem.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/verification/problems.hpp"

#include <cmath>

namespace experiments {

using namespace reference_fem;

namespace {

constexpr int cells = 4;  // along each edge of the cube
constexpr double formal_order = 2.0;

// Root mean square over the vertices [m].
double rms(const pbs::Positions& positions, const pbs::Positions& other)
{
    return (positions - other).norm() / std::sqrt(static_cast<double>(positions.rows()));
}

// At the common vertices. The values are not a number where Newton's method does not converge.
struct NestedSolutions {
    pbs::Positions exact, linear{}, linear_refined{}, quadratic{}, finest{};
    int dofs = 0;  // of the finest

    double error_of(const pbs::Positions& positions) const { return rms(positions, exact); }
    double from_finest(const pbs::Positions& positions) const { return rms(positions, finest); }
};

NestedSolutions solve_nested(const Effort& effort)
{
    const pbs::TetMesh mesh = jittered_cube(cells, 0.25), refined = pbs::refine(mesh).mesh;
    NestedSolutions solutions{.exact = exact_positions(mesh.rest)};
    const auto solved = [&](const pbs::TetMesh& on, int element_order) -> pbs::Positions {
        const AttachedSolution solution =
            solve_manufactured(on, element_order, {}, solver_material(effort, manufactured_material));
        solutions.dofs = solution.dofs;
        if (solution.converged) return solution.positions.topRows(mesh.rest.rows());
        return pbs::Positions::Constant(mesh.rest.rows(), 3, not_reached);
    };
    solutions.linear = solved(mesh, 1);
    solutions.linear_refined = solved(refined, 1);
    solutions.quadratic = solved(mesh, 2);
    solutions.finest = solved(refined, 2);
    return solutions;
}

VerificationRow row_of(const RowQuantity& quantity, int element_order, double value, double reference,
                       const std::string& unit, int dofs)
{
    return row_about({"nested_convergence", elements_of(element_order),
                      material_of("stable_neo_hookean", manufactured_material.poisson),
                      text_of({cells, cells, cells}) + " jittered, and cut into eight", 0.5 / cells, dofs},
                     quantity, value, reference, unit,
                     "closed form: u_i = A sin(a_i . x + phi_i) with the springs and the body force that belong to it");
}

// The finest solution stands for the limit. Its error changes the two distances of the linear ones by at most itself.
VerificationRow order_row(const NestedSolutions& solutions, const analysis::NestedOrder& order)
{
    const double linear = solutions.error_of(solutions.linear), refined = solutions.error_of(solutions.linear_refined),
                 finest = solutions.error_of(solutions.finest);
    VerificationRow row =
        row_of({"observed_order", "order of linear elements by their distances from the finest solution"}, 1,
               order.observed, std::log2(linear / refined), "1", solutions.dofs);
    bound(row, row.reference + std::log2((1.0 - finest / linear) / (1.0 + finest / refined)),
          row.reference + std::log2((1.0 + finest / linear) / (1.0 - finest / refined)),
          "the order of the true errors; the error of the finest solution changes each distance by at most itself");
    row.note = order.reliable ? "reliable" : "not reliable";
    return row;
}

// The bound must cover the true error and be smaller than the error of the next coarser solution.
VerificationRow bound_row(const NestedSolutions& solutions, const RowQuantity& quantity, double value,
                          const pbs::Positions& positions, const pbs::Positions& coarser)
{
    VerificationRow row = row_of(quantity, 2, value, solutions.error_of(positions), "m", solutions.dofs);
    bound(row, row.reference, solutions.error_of(coarser),
          "the true errors of the solution and of the refined linear one");
    return row;
}

}  // namespace

VerificationRows nested_convergence_rows(const Effort& effort)
{
    const NestedSolutions nested = solve_nested(effort);
    const double quadratic = nested.from_finest(nested.quadratic);
    const analysis::NestedOrder order = analysis::nested_order(
        {nested.from_finest(nested.linear), nested.from_finest(nested.linear_refined), quadratic}, formal_order);
    return {order_row(nested, order),
            bound_row(nested, {"bound", "bound of the error of the finest solution (reference: its true error)"},
                      order.bound(quadratic), nested.finest, nested.linear_refined)};
}

}  // namespace experiments
