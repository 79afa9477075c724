#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/solver/options.hpp"

namespace experiments {
namespace {

pbs::XpbdOptions& xpbd_of(StabilityCell& cell)
{
    return options_of<pbs::XpbdOptions>(cell.spec);
}

const Sweep youngs{"young", "Pa", {1.0, 1e12}, {1e3, 1e7, 1e9}, [](StabilityCell& cell, double pa) { xpbd_of(cell).young_pa = pa; }};
const Sweep poissons{
    "poisson", "1", {0.25, 0.499999}, {0.45, 0.49, 0.499, 0.4999}, [](StabilityCell& cell, double nu) { xpbd_of(cell).poisson = nu; }};
const Sweep gravities{
    "gravity", "g", {1.0, 1e4}, {100.0}, [](StabilityCell& cell, double count) { xpbd_of(cell).gravity_m_s2.y() = -g_m_s2 * count; }};
const Sweep iterations{"iterations", "1", {1.0, 96.0}, {4.0, 384.0}, [](StabilityCell& cell, double count) {
                           xpbd_of(cell).iterations = static_cast<int>(count);
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

}  // namespace

std::vector<StabilityCell> xpbd_cells(bool full)
{
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

}  // namespace experiments
