// The order and the bound of a reference from nested solutions, on flesh with smooth springs whose exact solution is known: linear and
// quadratic elements on some tets and on these tets cut into eight, as PosedReference solves them.

#include "analysis/statistics/fits.hpp"
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
double rms(const pbs::Positions& one, const pbs::Positions& other)
{
    return (one - other).norm() / std::sqrt(static_cast<double>(one.rows()));
}

// At the common vertices. The values are not a number where Newton's method does not converge.
struct NestedSolutions {
    pbs::Positions exact, linear, linear_refined, quadratic, finest;
    int dofs = 0;  // of the finest

    double error_of(const pbs::Positions& positions) const { return rms(positions, exact); }
    double from_finest(const pbs::Positions& positions) const { return rms(positions, finest); }
};

NestedSolutions solve_nested(const Effort& effort)
{
    const pbs::TetMesh mesh = jittered_cube(cells, 0.25), refined = pbs::refine(mesh).mesh;
    NestedSolutions solutions{.exact = exact_positions(mesh.rest)};
    const auto solved = [&](const pbs::TetMesh& on, int element_order) -> pbs::Positions {
        const AttachedSolution solution = solve_manufactured(on, element_order, {}, solver_material(effort, manufactured_material));
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

VerificationRow row_of(const RowQuantity& quantity, int element_order, double value, double reference, const std::string& unit, int dofs)
{
    return row_about({"nested_convergence", elements_of(element_order), material_of("stable_neo_hookean", manufactured_material.poisson),
                      text_of({cells, cells, cells}) + " jittered, and cut into eight", 0.5 / cells, dofs},
                     quantity, value, reference, unit,
                     "closed form: u_i = A sin(a_i . x + phi_i) with the springs and the body force that belong to it");
}

// The finest solution stands for the limit. Its error changes the two distances of the linear ones by at most itself.
VerificationRow order_row(const NestedSolutions& solutions, const analysis::NestedOrder& order)
{
    const double linear = solutions.error_of(solutions.linear), refined = solutions.error_of(solutions.linear_refined),
                 finest = solutions.error_of(solutions.finest);
    VerificationRow row = row_of({"observed_order", "order of linear elements by their distances from the finest solution"}, 1,
                                 order.observed, std::log2(linear / refined), "1", solutions.dofs);
    bound(row, row.reference + std::log2((1.0 - finest / linear) / (1.0 + finest / refined)),
          row.reference + std::log2((1.0 + finest / linear) / (1.0 - finest / refined)),
          "the order of the true errors; the error of the finest solution changes each distance by at most itself");
    row.note = order.reliable ? "reliable" : "not reliable";
    return row;
}

// The bound must cover the true error and be smaller than the error of the next coarser solution.
VerificationRow bound_row(const NestedSolutions& solutions, const RowQuantity& quantity, double value, const pbs::Positions& of,
                          const pbs::Positions& coarser)
{
    VerificationRow row = row_of(quantity, 2, value, solutions.error_of(of), "m", solutions.dofs);
    bound(row, row.reference, solutions.error_of(coarser), "the true errors of the solution and of the refined linear one");
    return row;
}

VerificationRow limit_row(const NestedSolutions& solutions, const analysis::NestedOrder& order)
{
    const pbs::Positions limit = analysis::extrapolated(solutions.finest, solutions.quadratic, order.order + 1.0);
    VerificationRow row = row_of({"extrapolated_error", "error of the extrapolated quadratic solutions"}, 2, solutions.error_of(limit), 0.0,
                                 "m", solutions.dofs);
    bound(row, 0.0, solutions.error_of(solutions.finest),
          "the true error of the finest solution, from which it must extrapolate towards the limit");
    return row;
}

// Least squares over the errors on three nested meshes.
VerificationRow least_squares_row(const Effort& effort)
{
    std::vector<double> h_m, errors;
    pbs::TetMesh mesh = jittered_cube(cells, 0.25);
    int dofs = 0;
    for (int level = 0; level < 3; ++level) {
        const AttachedSolution solution = solve_manufactured(mesh, 1, {}, solver_material(effort, manufactured_material));
        h_m.push_back(1.0 / (cells << level));
        errors.push_back(solution.error);
        dofs = solution.dofs;
        mesh = pbs::refine(mesh).mesh;
    }
    VerificationRow row = row_of({"least_squares_order", "order of the error in L2 on three meshes, by least squares"}, 1,
                                 analysis::observed_order(h_m, errors).slope.estimate, formal_order, "1", dofs);
    row.mesh = text_of({cells, cells, cells}) + " jittered, and cut into eight twice";
    row.h_m = h_m.back();
    bound(row, formal_order - 2.0 * order_tolerance, formal_order + 2.0 * order_tolerance,
          "order of interpolation (Brenner and Scott 2008, ch. 5) within 0.2: errors C h^2 (1 + c h) on the coarser meshes");
    return row;
}

constexpr double published_order = 1.786170, published_index_pct = 0.103083, published_factor = 1.25;

VerificationRow row_of(const RowQuantity& quantity, const std::string& unit, double value, double reference, double half_a_digit)
{
    VerificationRow row =
        row_about({"grid_convergence", {.formulation = "two_grids"}, {"none"}, "ratio 2", 0.0, 0}, quantity, value, reference, unit,
                  "NPARC Alliance CFD Verification and Validation, Examining spatial (grid) convergence");
    bound(row, reference - half_a_digit, reference + half_a_digit, "half of the last printed digit");
    return row;
}

}  // namespace

VerificationRows nested_convergence_rows(const Effort& effort)
{
    const NestedSolutions nested = solve_nested(effort);
    const double quadratic = nested.from_finest(nested.quadratic);
    const analysis::NestedOrder order =
        analysis::nested_order({nested.from_finest(nested.linear), nested.from_finest(nested.linear_refined), quadratic}, formal_order);
    const double to_linear = rms(nested.quadratic, nested.linear_refined);
    const analysis::NestedOrder without_finest =
        analysis::order_without_finest(rms(nested.linear, nested.quadratic), to_linear, formal_order);
    return {order_row(nested, order),
            bound_row(nested, {"bound", "bound of the error of the finest solution (reference: its true error)"}, order.bound(quadratic),
                      nested.finest, nested.linear_refined),
            bound_row(nested,
                      {"bound", "bound of the error of the unrefined quadratic solution without the finest one (reference: its true error)",
                       "without_finest"},
                      to_linear + without_finest.bound(rms(nested.linear, nested.linear_refined)), nested.quadratic, nested.linear),
            limit_row(nested, order), least_squares_row(effort)};
}

// The grid convergence index of an error bar from two solutions, against a published example: pressure recovery on three grids (NPARC
// Alliance CFD Verification and Validation, tutorial "Examining spatial (grid) convergence", after P. J. Roache 1994). The example observes
// its order on the third grid, and its safety factor is 1.25; with two grids the order is presumed and the factor is 3.

VerificationRows grid_convergence_rows(const Effort&)
{
    const analysis::GridConvergence grids = analysis::two_grids({0.97050, 0.96854}, 2.0, published_order);
    const double factor = analysis::grid_safety_factor / published_factor;
    return {row_of({"grid_convergence_index", "grid convergence index of the finer grid with the safety factor 3"}, "%",
                   100.0 * grids.bounds[0] / 0.97050, factor * published_index_pct, factor * 5e-7),
            row_of({"extrapolated_value", "extrapolated pressure recovery"}, "1", grids.extrapolated, 0.97130, 5e-6)};
}

}  // namespace experiments
