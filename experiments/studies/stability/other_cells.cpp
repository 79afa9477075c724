#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/stability/cell_sweep.hpp"
#include "experiments/studies/stability/stability_body.hpp"
#include "experiments/studies/stability/stability_cells.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

// The deformers that are compared with PBS, and whether they take an initial guess: a broken one is an initial state of theirs.
struct Compared {
    const char* kind;
    bool minimises;
};
constexpr Compared compared[] = {{"quasi_newton", true},        {"vbd", true},         {"xpbd_neo_hookean", true},
                                 {"projective_dynamics", true}, {"delta_mush", false}, {"direct_delta_mush", false},
                                 {"pbs_author", false}};

// The deformer with one key of its table set, as a scene would set it.
DeformerSpec with_setting(const std::string& kind, const std::string& key, double value)
{
    return spec_of(read_scene("limb_bend", {"reference.name=\"\"", fmt::format("deformers.use=[\"{}\"]", kind),
                                            fmt::format("{}.{}={:.17g}", kind, key, value)}),
                   kind);
}

bool has_key(const std::string& kind, const std::string& name)
{
    const std::vector<SceneKey>& keys = find_deformer_kind(kind)->keys;
    return std::any_of(keys.begin(), keys.end(), [&](const SceneKey& key) { return key.name == name; });
}

const Sweep poissons{"poisson", "1", {0.0, 0.499}, {0.3, 0.45, 0.49, 0.4999}, [](StabilityCell& cell, double nu) {
                         cell.spec = with_setting(cell.spec.kind, "poisson", nu);
                     }};
const Sweep iterations{"iterations", "1", {1.0, 96.0}, {4.0, 384.0}, [](StabilityCell& cell, double count) {
                           cell.spec = with_setting(cell.spec.kind, "iterations", count);
                       }};

StabilityCell base(const std::string& kind)
{
    StabilityCell cell;
    cell.model = kind;
    cell.spec = default_spec(kind);
    cell.still_steps = make_deformer(cell.spec)->has_memory() ? 100 : 12;
    return cell;
}

}  // namespace

std::vector<StabilityCell> other_cells(bool full)
{
    std::vector<StabilityCell> cells;
    for (const auto& [kind, minimises] : compared) {
        const StabilityCell from = base(kind);
        for (const Sweep* sweep : {&time_steps, &twists, &jumps, &teleports, &slivers, &needles})
            append(cells, cells_of(*sweep, from, full));
        if (minimises) append(cells, cells_of(starts, from, full));
        if (has_key(kind, "poisson")) append(cells, cells_of(poissons, from, full));
        if (has_key(kind, "iterations")) append(cells, cells_of(iterations, from, full));
    }
    return cells;
}

}  // namespace experiments
