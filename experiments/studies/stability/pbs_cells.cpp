#include "experiments/deformers/deformer_options.hpp"
#include "experiments/studies/stability/stability_cells.hpp"

#include <cmath>

namespace experiments {
namespace {

constexpr pbs::Precision both_precisions[] = {pbs::Precision::f32, pbs::Precision::f64};

pbs::PbsOptions& pbs_of(StabilityCell& cell)
{
    return options_of<pbs::PbsOptions>(cell.spec);
}

void set_k_stretch(StabilityCell& cell, double k)
{
    pbs_of(cell).k_stretch = k;
    if (pbs_of(cell).jiggle) pbs_of(cell).jiggle->k_stretch = k;
}

void set_mass_ratio(StabilityCell& cell, double ratio)
{
    cell.mass_ratio = ratio;
}

const Sweep k_stretches{"k_stretch", "1", {0.0, 0.2, 0.6, 1.0}, {0.01, 0.1, 0.4, 0.8, 0.9}, set_k_stretch};
const Sweep k_volumes{
    "k_volume", "1", {0.0, 0.5, 1.0}, {0.1, 0.25, 0.75}, [](StabilityCell& cell, double k) { pbs_of(cell).k_volume = k; }};
const Sweep k_binds{"k_bind", "1", {0.0, 0.5, 1.0}, {0.1, 0.25, 0.75}, [](StabilityCell& cell, double k) { pbs_of(cell).k_bind = k; }};
const Sweep iterations{"iterations", "1", {1.0, 24.0, 1000.0}, {2.0, 4.0, 8.0, 96.0, 384.0}, [](StabilityCell& cell, double count) {
                           pbs_of(cell).iterations = static_cast<int>(count);
                       }};
const Sweep iterations_of_maps{"iterations", "1", {1.0, 4.0, 24.0, 96.0}, {2.0, 8.0, 384.0}, iterations.set};
const Sweep clip_time_steps{
    "time_step", "s", {1e-4, 0.1, 1.0}, {1e-3, 0.01}, [](StabilityCell& cell, double value) { cell.time_step_s = value; }};
const Sweep gravities{"gravity", "g", {1.0, 100.0, 1e4}, {10.0, 1e3}, [](StabilityCell& cell, double count) {
                          pbs_of(cell).gravity_m_s2.y() = -g_m_s2 * count;
                      }};
const Sweep mass_ratios{"mass_ratio", "1", {1e2, 1e8}, {1e4, 1e6}, set_mass_ratio, false};
const Sweep held_ends{"held_end", "1", {1.0}, {}, [](StabilityCell& cell, double) { cell.held_end = true; }, false};
const Sweep orders{"order", "", {1.0, 2.0}, {}, [](StabilityCell& cell, double value) {
                       pbs_of(cell).order = value == 1.0 ? pbs::Order::plain : pbs::Order::grouped;
                       cell.named = value == 1.0 ? "plain" : "grouped";
                   }};

void set_form(StabilityCell& cell, double value)
{
    pbs_of(cell).volume_form = static_cast<pbs::VolumeForm>(std::lround(value));
    cell.named = name_of(pbs_of(cell).volume_form);
}

const Sweep printed_forms{"printed_form", "", {1.0, 2.0, 3.0, 4.0}, {}, set_form, false};
void set_bind_of_form(StabilityCell& cell, double k_bind)
{
    pbs_of(cell).k_bind = k_bind;
    cell.named = name_of(pbs_of(cell).volume_form);
}

const Sweep without_bind{"sign_k_bind", "1", {0.0}, {}, set_bind_of_form, false};
// The square of the distance overflows in f32, and in f64. This is a limit of the numbers, not of the method.
const Sweep beyond_numbers{
    "teleport_beyond_numbers", "m", {1e25, 1e160}, {}, [](StabilityCell& cell, double m) { cell.disturbance.teleport_m = m; }, false};

StabilityCell base(const std::string& body, bool jiggle, pbs::Precision precision, bool full)
{
    StabilityCell cell;
    cell.body = body;
    cell.model = jiggle ? "pbs_jiggle" : "pbs";
    pbs::PbsOptions options;
    options.precision = precision;
    options.gravity_m_s2 = pbs::Vec3(0.0, -g_m_s2, 0.0);
    if (jiggle) options.jiggle = pbs::Jiggle{options.k_stretch};
    cell.spec = {.name = "pbs", .kind = "pbs", .label = "pbs", .variant = jiggle ? "jiggle" : "default", .options = options};
    cell.still_steps = full ? 800 : 600;
    cell.as_published = true;
    return cell;
}

// Without jiggle particles have no memory. Neither the time step nor gravity has an effect, and a few steps at rest suffice.
StabilityCell without_memory(StabilityCell cell)
{
    cell.still_steps = 12;
    return cell;
}

// These cells are stable by construction. They are a control and no part of the claim.
std::vector<StabilityCell> time_steps_without_effect(StabilityCell from, bool full)
{
    from.model = "pbs_no_memory";
    from.as_published = false;
    return cells_of(time_steps, from, full);
}

}  // namespace

std::vector<StabilityCell> pbs_cells(bool jiggle, bool full)
{
    std::vector<StabilityCell> cells;
    for (const pbs::Precision precision : both_precisions) {
        const StabilityCell start = base("limb", jiggle, precision, full), from = jiggle ? start : without_memory(start);
        append(cells, jiggle ? cells_of(time_steps, from, full) : time_steps_without_effect(from, full));
        for (const Sweep* sweep : {&teleports, &starts}) append(cells, cells_of(*sweep, from, full));
        if (precision == pbs::Precision::f64 && !full) continue;
        for (const Sweep* sweep :
             {&k_stretches, &k_volumes, &k_binds, &iterations, &twists, &jumps, &slivers, &needles, &mass_ratios, &held_ends, &orders})
            append(cells, cells_of(*sweep, from, full));
        if (jiggle) append(cells, cells_of(gravities, from, full));
    }
    return cells;
}

std::vector<StabilityCell> pbs_character_cells(const std::string& body, bool full)
{
    std::vector<StabilityCell> cells;
    for (const bool jiggle : {false, true}) {
        StabilityCell start = base(body, jiggle, pbs::Precision::f32, full);
        start.still_steps = full ? 500 : 200;
        const StabilityCell from = jiggle ? start : without_memory(start);
        for (const Sweep* sweep : {&k_stretches, &teleports, &starts}) append(cells, cells_of(*sweep, from, full));
        if (!jiggle) continue;
        append(cells, cells_of(clip_time_steps, from, full));
        append(cells, cells_of(gravities, from, full));
        append(cells, cells_of(iterations_of_maps, from, full));
    }
    return cells;
}

std::vector<StabilityCell> pbs_map_cells(bool full)
{
    const StabilityCell from = base("limb", true, pbs::Precision::f32, full);
    std::vector<StabilityCell> cells = cells_of_map(time_steps, k_stretches, from, full);
    append(cells, cells_of_map(iterations_of_maps, twists, from, full));
    return cells;
}

std::vector<StabilityCell> negative_controls()
{
    std::vector<StabilityCell> cells;
    for (const bool jiggle : {false, true})
        for (const pbs::Precision precision : both_precisions) {
            StabilityCell from = base("limb", jiggle, precision, false);
            from.still_steps = 60;
            pbs_of(from).order = pbs::Order::plain;
            if (!jiggle) from = without_memory(from);
            append(cells, cells_of(printed_forms, from, false));
            if (jiggle) append(cells, cells_of(beyond_numbers, from, false));
            pbs_of(from).volume_form = pbs::VolumeForm::sign;
            append(cells, cells_of(without_bind, from, false));
        }
    return cells;
}

}  // namespace experiments
