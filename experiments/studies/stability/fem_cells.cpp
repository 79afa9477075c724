#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/stability/stability_cells.hpp"

namespace experiments {
namespace {

using reference_fem::Dynamics;
using reference_fem::Model;

FemOptions& fem_of(StabilityCell& cell)
{
    return options_of<FemOptions>(cell.spec);
}

const Sweep youngs{"young", "Pa", {1e5, 1e12}, {1.0, 1e3, 1e7, 1e9}, [](StabilityCell& cell, double pa) { fem_of(cell).young_pa = pa; }};
const Sweep poissons{
    "poisson", "1", {0.3, 0.4999}, {0.0, 0.45, 0.49, 0.499, 0.499999}, [](StabilityCell& cell, double nu) { fem_of(cell).poisson = nu; }};
const Sweep gravities{
    "gravity", "g", {10.0}, {100.0, 1e3, 1e4}, [](StabilityCell& cell, double count) { fem_of(cell).gravity_m_s2.y() = -g_m_s2 * count; }};

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

}  // namespace

std::vector<StabilityCell> fem_static_cells(bool full)
{
    std::vector<StabilityCell> cells;
    for (const Model model : {Model::linear, Model::corotational, Model::stable_neo_hookean})
        for (const Sweep* sweep : {&youngs, &poissons, &gravities, &twists, &jumps, &teleports, &starts, &slivers})
            append(cells, cells_of(*sweep, base(model, Dynamics::quasi_static), full));
    return cells;
}

std::vector<StabilityCell> fem_dynamic_cells(bool full)
{
    std::vector<StabilityCell> cells;
    for (const Model model : {Model::corotational, Model::stable_neo_hookean}) {
        if (model == Model::corotational && !full) continue;
        StabilityCell from = base(model, Dynamics::generalized_alpha);
        from.still_steps = full ? 300 : 100;
        for (const Sweep* sweep : {&timed, &youngs, &teleports}) append(cells, cells_of(*sweep, from, full));
    }
    return cells;
}

}  // namespace experiments
