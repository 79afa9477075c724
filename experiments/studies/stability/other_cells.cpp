#include "experiments/deformers/registry.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/author/author_solver.hpp"

#include <nlohmann/json.hpp>

namespace experiments {
namespace {

const Sweep poissons{"poisson", "1", {0.0, 0.499}, {0.3, 0.45, 0.49, 0.4999}, [](StabilityCell& cell, double nu) {
                         cell.spec = with_option(cell.spec, "poisson", nu);
                     }};
const Sweep iterations{"iterations", "1", {1.0, 96.0}, {4.0, 384.0}, [](StabilityCell& cell, double count) {
                           cell.spec = with_option(cell.spec, "iterations", static_cast<int>(count));
                       }};

// The methods take no time step from the motion, so that one cell stands for all of them.
const Sweep no_time_step{"time_step", "s", {1.0}, {}, [](StabilityCell& cell, double time_step_s) {
                             time_steps.set(cell, time_step_s);
                             cell.named = "not_used";
                         }};

// The time step of pbs_author is a setting of its own. It cancels without gravity.
const Sweep own_time_steps{"own_time_step", "s", {1e-3, 0.1, 1.0}, {0.01, 0.03, 0.3}, [](StabilityCell& cell, double time_step_s) {
                               auto& options = options_of<pbs::AuthorOptions>(cell.spec);
                               options.time_step_s = time_step_s;
                               options.gravity_m_s2.y() = -g_m_s2;
                           }};

// The spectral radius that Chebyshev's weights assume. Above that of the sweeps the method may diverge.
const Sweep chebyshev_radii{"chebyshev_rho", "1", {0.95, 0.9999}, {0.9, 0.99, 0.999}, [](StabilityCell& cell, double rho) {
                                cell.spec = with_option(with_option(cell.spec, "acceleration", "chebyshev"), "rho", rho);
                            }};
const Sweep relaxations{
    "omega", "1", {1.0, 1.999}, {1.5, 1.95}, [](StabilityCell& cell, double omega) { cell.spec = with_option(cell.spec, "omega", omega); }};
// In units of the time in which the stiffness of a vertex moves its mass. The default is 0.8, which is known to converge.
const Sweep step_shares{"step_of_stiffness", "1", {0.8, 16.0}, {1.0, 1.5, 2.0, 4.0}, [](StabilityCell& cell, double share) {
                            cell.spec = with_option(cell.spec, "time_step", share);
                        }};

StabilityCell base(const std::string& kind)
{
    StabilityCell cell;
    cell.model = kind;
    cell.spec = default_spec(kind);
    cell.still_steps = 12;
    if (make_deformer(cell.spec)->has_memory()) {
        cell.still_steps = 100;
        cell.nudge_m = 1e-9;
    }
    return cell;
}

}  // namespace

const std::vector<ComparedKind>& compared_kinds()
{
    static const std::vector<ComparedKind> kinds = {
        {"quasi_newton", true, ""},
        {"vbd", true, "", {&chebyshev_radii, &relaxations}},
        {"xpbd_neo_hookean", true, "", {&step_shares}},
        {"projective_dynamics", true, ""},
        {"delta_mush", false, "a function of the pose alone"},
        {"direct_delta_mush", false, "a function of the pose alone"},
        {"pbs_author", false,
         "each frame begins at the shape of LBS; only the displacement of the last frame is kept, which teleports make extreme"}};
    return kinds;
}

std::vector<StabilityCell> other_cells(bool full)
{
    std::vector<StabilityCell> cells;
    for (const ComparedKind& compared : compared_kinds()) {
        const StabilityCell from = base(compared.kind);
        for (const Sweep* sweep : {&no_time_step, &twists, &jumps, &teleports, &slivers, &needles})
            append(cells, cells_of(*sweep, from, full));
        if (options_if<pbs::AuthorOptions>(from.spec)) append(cells, cells_of(own_time_steps, from, full));
        if (has_option(compared.kind, "poisson")) append(cells, cells_of(poissons, from, full));
        if (has_option(compared.kind, "iterations")) append(cells, cells_of(iterations, from, full));
        for (const Sweep* sweep : compared.beyond_limits) append(cells, cells_of(*sweep, from, full));
    }
    return cells;
}

}  // namespace experiments
