#include "experiments/studies/stability/stability_cells.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/settings/scene_values.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace experiments {

std::string precision_of(const StabilityCell& cell)
{
    return traits_of(cell.spec).precision;
}

RECORD_SETTINGS(Disturbance, axis, angle_deg, turning_steps, teleport_m, start, stays)

RECORD_SETTINGS_AND(StabilityCell, .record("deformer", &StabilityCell::spec), body, model, factor, value, unit, second_factor, second_value,
                    second_unit, named, disturbance, time_step_s, still_steps, defect, thinness, mass_ratio, held_end, nudge_m,
                    as_published)

std::string setting_of(const StabilityCell& cell)
{
    nlohmann::json setting = to_json(cell);
    for (const char* of_the_way :
         {"model", "factor", "value", "unit", "second_factor", "second_value", "second_unit", "named", "as_published"})
        setting.erase(of_the_way);
    for (const char* of_the_way : {"turning_steps", "start", "stays"}) setting["disturbance"].erase(of_the_way);
    return setting.dump();
}

namespace {

constexpr double degrees_per_step = 15.0, turning_s = 0.1;

// The turn takes a tenth of a second, but at least one step, for every time step.
void set_time_step(StabilityCell& cell, double time_step_s)
{
    cell.time_step_s = time_step_s;
    cell.disturbance.turning_steps = std::max(1, static_cast<int>(std::lround(turning_s / time_step_s)));
}

void twist(StabilityCell& cell, double angle_deg)
{
    cell.disturbance.axis = pbs::Vec3::UnitX();
    cell.disturbance.angle_deg = angle_deg;
    cell.disturbance.turning_steps = std::max(1, static_cast<int>(std::ceil(angle_deg / degrees_per_step)));
}

void jump(StabilityCell& cell, double angle_deg)
{
    cell.disturbance.angle_deg = angle_deg;
    cell.disturbance.turning_steps = 1;
}

void start(StabilityCell& cell, double value)
{
    static const char* const names[] = {"as_posed", "flattened", "mirrored", "random", "point"};
    cell.disturbance.start = static_cast<Start>(std::lround(value));
    cell.named = names[std::lround(value)];
}

template <Defect defect>
void spoil(StabilityCell& cell, double thinness)
{
    cell.defect = defect;
    cell.thinness = thinness;
}

std::vector<double> values_of(const Sweep& sweep, bool full)
{
    std::vector<double> values = sweep.values;
    if (full) values.insert(values.end(), sweep.more.begin(), sweep.more.end());
    std::sort(values.begin(), values.end());
    return values;
}

}  // namespace

const Sweep time_steps{"time_step", "s", {1e-4, 0.01, 0.1, 1.0}, {1e-3, 3e-3, 0.03, 0.3}, set_time_step};
const Sweep twists{"twist", "deg", {0.0, 90.0, 180.0, 360.0, 720.0}, {45.0, 135.0, 270.0, 540.0}, twist};
const Sweep jumps{"bend_in_one_step", "deg", {90.0, 180.0}, {45.0, 135.0}, jump};
const Sweep teleports{
    "teleport", "m", {10.0, 1000.0}, {0.1, 1.0}, [](StabilityCell& cell, double value) { cell.disturbance.teleport_m = value; }};
const Sweep starts{"start", "", {1.0, 2.0, 3.0, 4.0}, {}, start};
const Sweep slivers{"slivers_height_kept", "1", {1e-2, 1e-6}, {1e-1, 1e-3, 1e-4, 1e-5}, spoil<Defect::slivers>};
const Sweep needles{"needles_edge_kept", "1", {1e-2, 1e-6}, {1e-1, 1e-3, 1e-4, 1e-5}, spoil<Defect::needles>};

std::vector<StabilityCell> cells_of(const Sweep& sweep, const StabilityCell& base, bool full)
{
    std::vector<StabilityCell> cells;
    for (const double value : values_of(sweep, full)) {
        StabilityCell cell = base;
        cell.factor = sweep.factor;
        cell.value = value;
        cell.unit = sweep.unit;
        cell.as_published = base.as_published && sweep.as_published;
        sweep.set(cell, value);
        cells.push_back(std::move(cell));
    }
    return cells;
}

std::vector<StabilityCell> cells_of_map(const Sweep& rows, const Sweep& columns, const StabilityCell& base, bool full)
{
    std::vector<StabilityCell> cells;
    for (const StabilityCell& row : cells_of(rows, base, full))
        for (StabilityCell& cell : cells_of(columns, row, full)) {
            cell.second_factor = std::exchange(cell.factor, row.factor);
            cell.second_value = std::exchange(cell.value, row.value);
            cell.second_unit = std::exchange(cell.unit, row.unit);
            cells.push_back(std::move(cell));
        }
    return cells;
}

void append(std::vector<StabilityCell>& cells, std::vector<StabilityCell> more)
{
    cells.insert(cells.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

bool has_option(const std::string& kind, const std::string& key)
{
    const std::vector<SceneKey>& keys = find_deformer_kind(kind)->keys;
    return std::any_of(keys.begin(), keys.end(), [&](const SceneKey& one) { return one.table == kind && one.name == key; });
}

// The numbers, texts and truth values of JSON are spelled as in TOML.
DeformerSpec with_option(const DeformerSpec& spec, const std::string& key, const nlohmann::json& value)
{
    const DeformerKind& kind = *find_deformer_kind(spec.kind);
    nlohmann::json options = kind.options_json(spec);
    options[key] = value;
    std::vector<std::string> overrides;
    for (const auto& [name, setting] : options.items()) overrides.push_back(spec.kind + "." + name + "=" + setting.dump());
    DeformerSpec changed = spec;
    kind.read(SceneValues("schema = 1\n", "stability", overrides, scene_schema()), spec.kind, changed);
    return changed;
}

}  // namespace experiments
