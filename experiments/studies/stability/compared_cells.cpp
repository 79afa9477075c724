// The cells of the methods that are compared with PBS: XPBD, the finite elements, and the other deformers, these also from broken initial
// shapes.
#include "experiments/deformers/registry.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/solver/options.hpp"

#include <nlohmann/json.hpp>

namespace experiments {
namespace {

using reference_fem::Dynamics;
using reference_fem::Model;

template <typename Options>
void set_young(StabilityCell& cell, double pa)
{
    options_of<Options>(cell.spec).young_pa = pa;
}

template <typename Options>
void set_poisson(StabilityCell& cell, double poisson)
{
    options_of<Options>(cell.spec).poisson = poisson;
}

template <typename Options>
void set_gravity(StabilityCell& cell, double count)
{
    options_of<Options>(cell.spec).gravity_m_s2.y() = -g_m_s2 * count;
}

namespace of_xpbd {

const Sweep youngs{"young", "Pa", {1.0, 1e12}, {1e3, 1e7, 1e9}, set_young<pbs::XpbdOptions>};
const Sweep poissons{"poisson", "1", {0.25, 0.499999}, {0.45, 0.49, 0.499, 0.4999}, set_poisson<pbs::XpbdOptions>};
const Sweep gravities{"gravity", "g", {1.0, 1e4}, {100.0}, set_gravity<pbs::XpbdOptions>};
const Sweep iterations{"iterations", "1", {1.0, 96.0}, {4.0, 384.0}, [](StabilityCell& cell, double count) {
                           options_of<pbs::XpbdOptions>(cell.spec).iterations = static_cast<int>(count);
                       }};

// The zone, the cost and gravity are those of PBS with jiggle.
StabilityCell base(bool small_steps, bool full)
{
    StabilityCell cell;
    cell.model = small_steps ? "xpbd_small_steps" : "xpbd";
    pbs::XpbdOptions options;
    options.jiggle = true;
    options.gravity_m_s2 = pbs::Vec3(0.0, -g_m_s2, 0.0);
    if (small_steps) std::swap(options.iterations, options.substeps);
    cell.spec = {.name = cell.model, .kind = cell.model, .label = cell.model, .options = options};
    cell.still_steps = full ? 300 : 100;
    return cell;
}

}  // namespace of_xpbd

namespace of_fem {

const Sweep youngs{"young", "Pa", {1e5, 1e12}, {1.0, 1e3, 1e7, 1e9}, set_young<FemOptions>};
const Sweep poissons{"poisson", "1", {0.3, 0.4999}, {0.0, 0.45, 0.49, 0.499, 0.499999}, set_poisson<FemOptions>};
const Sweep gravities{"gravity", "g", {10.0}, {100.0, 1e3, 1e4}, set_gravity<FemOptions>};

// The smallest time steps take a thousand steps and more.
const Sweep timed{"time_step", "s", {0.01, 0.1, 1.0}, {1e-4, 1e-3}, [](StabilityCell& cell, double s) { time_steps.set(cell, s); }};

// Linear elements on the same tets. In time: generalised-alpha with stiffness-proportional damping, so that the body can come to rest.
StabilityCell base(Model model, Dynamics dynamics)
{
    const bool in_time = dynamics != Dynamics::quasi_static;
    StabilityCell cell;
    cell.model = "fem_" + name_of(model) + (in_time ? "_in_time" : "");
    FemOptions options;
    options.model = model;
    options.element_order = 1;
    options.dynamics = dynamics;
    options.gravity_m_s2 = pbs::Vec3(0.0, -g_m_s2, 0.0);
    if (in_time) options.rayleigh_stiffness_s = 0.05;
    cell.spec = {.name = cell.model, .kind = "fem", .label = cell.model, .options = options};
    cell.still_steps = 12;
    return cell;
}

}  // namespace of_fem

namespace of_others {

void set_poisson(StabilityCell& cell, double poisson)
{
    cell.spec = with_option(cell.spec, "poisson", poisson);
}

const Sweep poissons{"poisson", "1", {0.0, 0.499}, {0.3, 0.45, 0.49, 0.4999}, set_poisson};
const Sweep incompressible{"poisson", "1", {0.499}, {0.49}, set_poisson};
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
                               cell.time_step_s = time_step_s;  // by which it is counted
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

StabilityCell posed(const std::string& kind, bool is_twisted)
{
    StabilityCell cell;
    cell.model = kind;
    cell.spec = default_spec(kind);
    if (is_twisted) cell.disturbance.axis = pbs::Vec3::UnitX();
    return cell;
}

// A deformer that is compared with PBS.
struct ComparedKind {
    const char* kind;
    bool minimises;                                // an energy, from an initial guess
    const char* without_start;                     // why it has no broken start, otherwise
    std::vector<const Sweep*> beyond_limits = {};  // settings up to and beyond those for which it is known to converge
};

const ComparedKind compared_kinds[] = {
    {"quasi_newton", true, ""},
    {"vbd", true, "", {&chebyshev_radii, &relaxations}},
    {"xpbd_neo_hookean", true, "", {&step_shares}},
    {"projective_dynamics", true, ""},
    {"delta_mush", false, "a function of the pose alone"},
    {"direct_delta_mush", false, "a function of the pose alone"},
    {"pbs_author", false,
     "each frame begins at the shape of LBS; only the displacement of the last frame is kept, which teleports make extreme"}};

}  // namespace of_others

}  // namespace

std::vector<StabilityCell> xpbd_cells(bool full)
{
    using namespace of_xpbd;
    std::vector<StabilityCell> cells;
    for (const bool small_steps : {false, true}) {
        const StabilityCell from = base(small_steps, full);
        for (const Sweep* sweep : {&time_steps, &youngs, &poissons, &gravities, &starts}) append(cells, cells_of(*sweep, from, full));
        if (small_steps && !full) continue;
        for (const Sweep* sweep : {&twists, &teleports, &slivers}) append(cells, cells_of(*sweep, from, full));
        if (!small_steps) append(cells, cells_of(iterations, from, full));
    }
    return cells;
}

std::vector<StabilityCell> fem_static_cells(bool full)
{
    using namespace of_fem;
    std::vector<StabilityCell> cells;
    for (const Model model : {Model::linear, Model::corotational, Model::stable_neo_hookean})
        for (const Sweep* sweep : {&youngs, &poissons, &gravities, &twists, &jumps, &teleports, &starts, &slivers})
            append(cells, cells_of(*sweep, base(model, Dynamics::quasi_static), full));
    return cells;
}

std::vector<StabilityCell> fem_dynamic_cells(bool full)
{
    using namespace of_fem;
    std::vector<StabilityCell> cells;
    for (const Model model : {Model::corotational, Model::stable_neo_hookean}) {
        if (model == Model::corotational && !full) continue;
        StabilityCell from = base(model, Dynamics::generalized_alpha);
        from.still_steps = full ? 300 : 100;
        for (const Sweep* sweep : {&timed, &youngs, &teleports}) append(cells, cells_of(*sweep, from, full));
    }
    return cells;
}

std::vector<StabilityCell> other_cells(bool full)
{
    using namespace of_others;
    std::vector<StabilityCell> cells;
    for (const ComparedKind& compared : compared_kinds) {
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

std::vector<StabilityCell> start_cells(bool full)
{
    using namespace of_others;
    std::vector<StabilityCell> cells;
    for (const ComparedKind& compared : compared_kinds) {
        if (!compared.minimises) continue;
        for (const bool is_twisted : {false, true}) append(cells, cells_of(starts, posed(compared.kind, is_twisted), full));
        const StabilityCell twisted = posed(compared.kind, true);
        append(cells, cells_of_map(starts, incompressible, twisted, full));
        for (const Sweep* sweep : compared.beyond_limits) append(cells, cells_of_map(starts, *sweep, twisted, full));
    }
    return cells;
}

std::vector<StartRow> starts_not_applicable()
{
    std::vector<StartRow> rows;
    for (const auto& compared : of_others::compared_kinds) {
        if (compared.minimises) continue;
        StartRow row;
        row.body = "limb";
        row.model = compared.kind;
        row.precision = traits_of(default_spec(compared.kind)).precision;
        row.outcome = StartOutcome::not_applicable;
        row.reason = compared.without_start;
        rows.push_back(row);
    }
    return rows;
}

}  // namespace experiments
