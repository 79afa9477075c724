#include "experiments/studies/stability/stability_cells.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/solver/options.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace experiments {

std::string precision_of(const StabilityCell& cell)
{
    return traits_of(cell.spec).precision;
}

RECORD_SETTINGS(Disturbance, axis, angle_deg, turning_steps, teleport_m, start, stays)

RECORD_SETTINGS_AND(StabilityCell, .record("deformer", &StabilityCell::spec), body, model, factor, value, unit,
                    second_factor, second_value, second_unit, named, disturbance, time_step_s, still_steps, defect,
                    thinness, mass_ratio, held_end, nudge_m, as_published)

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

// A cell whose deformer is not read yet, and the settings in which it departs from the scene of cases.toml.
struct Draft {
    StabilityCell cell;
    Overrides overrides;
};

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

void bend_in_one_step(StabilityCell& cell, double angle_deg)
{
    cell.disturbance.angle_deg = angle_deg;
    cell.disturbance.turning_steps = 1;
}

template <Defect defect>
void spoil(StabilityCell& cell, double thinness)
{
    cell.defect = defect;
    cell.thinness = thinness;
}

// The factors that are no settings of a deformer. A time step alone leaves the number of steps of the turn as it is.
using SetFactor = void (*)(StabilityCell& cell, double value);
const std::map<std::string, SetFactor> cell_factors = {
    {"time_step", set_time_step},
    {"time_step_alone", [](StabilityCell& cell, double time_step_s) { cell.time_step_s = time_step_s; }},
    {"twist", twist},
    {"bend_in_one_step", bend_in_one_step},
    {"teleport", [](StabilityCell& cell, double length_m) { cell.disturbance.teleport_m = length_m; }},
    {"start", [](StabilityCell& cell, double) { cell.disturbance.start = option_of<Start>(cell.named); }},
    {"slivers_height_kept", spoil<Defect::slivers>},
    {"needles_edge_kept", spoil<Defect::needles>},
    {"mass_ratio", [](StabilityCell& cell, double ratio) { cell.mass_ratio = ratio; }},
    {"held_end", [](StabilityCell& cell, double) { cell.held_end = true; }}};

const nlohmann::json& document()
{
    static const nlohmann::json tables = cases_document("stability");
    return tables;
}

// A table of the list `sweep`.
const nlohmann::json& sweep_named(const std::string& name)
{
    const nlohmann::json& sweeps = document().at("sweep");
    const auto named =
        std::ranges::find_if(sweeps, [&](const nlohmann::json& sweep) { return sweep.at("name") == name; });
    if (named == sweeps.end()) throw std::logic_error("stability/cases.toml: no sweep " + name);
    return *named;
}

// Sets a factor of the cell, or adds an override.
void set(Draft& draft, const std::string& setting, const std::string& text, double value)
{
    if (const auto factor = cell_factors.find(setting); factor != cell_factors.end())
        factor->second(draft.cell, value);
    else
        draft.overrides.push_back(fmt::format(fmt::runtime(setting), text, fmt::arg("deformer", draft.cell.spec.kind)));
}

std::vector<Draft> varied(const Draft& base, const nlohmann::json& sweep, bool few)
{
    const std::string name = sweep.at("name");
    const auto values = sweep.value(few ? "few" : "values", sweep.at("values")).get<std::vector<double>>();
    const auto names = sweep.value("names", std::vector<std::string>());
    std::vector<Draft> drafts;
    for (std::size_t i = 0; i < values.size(); ++i) {
        Draft& draft = drafts.emplace_back(base);
        draft.cell.factor = sweep.value("factor", name);
        draft.cell.value = values[i];
        draft.cell.unit = sweep.at("unit");
        draft.cell.as_published = base.cell.as_published && sweep.value("as_published", true);
        if (!names.empty()) draft.cell.named = names.at(i);
        const std::string text = names.empty() ? fmt::format("{}", sweep.value("times", 1.0) * values[i]) : names.at(i);
        for (const std::string& setting : sweep.value("sets", std::vector{name})) set(draft, setting, text, values[i]);
    }
    return drafts;
}

std::vector<Draft> map_of(const Draft& base, const nlohmann::json& rows, const nlohmann::json& columns, bool few)
{
    std::vector<Draft> drafts;
    for (const Draft& row : varied(base, rows, few))
        for (Draft& draft : varied(row, columns, few)) {
            draft.cell.second_factor = std::exchange(draft.cell.factor, row.cell.factor);
            draft.cell.second_value = std::exchange(draft.cell.value, row.cell.value);
            draft.cell.second_unit = std::exchange(draft.cell.unit, row.cell.unit);
            drafts.push_back(std::move(draft));
        }
    return drafts;
}

// The deformer of this kind in the scene of cases.toml.
DeformerSpec deformer_with(const std::string& kind_name, const Overrides& overrides)
{
    const DeformerKind& kind = *find_deformer_kind(kind_name);
    const SceneValues values(document().at("scene"), "stability/cases.toml", overrides, scene_schema());
    const std::string table = kind.needs_list ? kind_name + ".0" : kind_name;
    DeformerSpec spec = default_spec(kind_name);
    if (kind.needs_list) spec.name = spec.label = values.text(table + ".name");
    kind.read(values, table, spec);
    return spec;
}

StabilityCell finished(Draft draft)
{
    draft.cell.spec = deformer_with(draft.cell.spec.kind, draft.overrides);
    if (draft.cell.model.empty()) draft.cell.model = draft.cell.spec.name;
    return draft.cell;
}

// The draft from which the sweeps of an entry of [[cells]] vary one factor.
Draft base_of(const nlohmann::json& entry, const std::string& body)
{
    StabilityCell cell;
    cell.body = body;
    cell.spec = default_spec(entry.at("deformer"));
    cell.model = entry.value("model", "");
    cell.still_steps = entry.at("still_steps");
    cell.nudge_m = entry.value("nudge_m", 0.0);
    cell.as_published = entry.value("as_published", options_if<pbs::PbsOptions>(cell.spec) != nullptr);
    if (entry.value("twisted", false)) cell.disturbance.axis = pbs::Vec3::UnitX();
    return {cell, entry.value("overrides", Overrides())};
}

// The judged cells in the same pose from the beginning, which is that of rest, and without gravity.
std::vector<StabilityCell> undisturbed(std::vector<StabilityCell> cells)
{
    std::erase_if(cells, [](const StabilityCell& cell) { return !cell.as_published || precision_of(cell) != "f64"; });
    for (StabilityCell& cell : cells) {
        cell.model = "pbs_undisturbed";
        cell.as_published = false;
        cell.disturbance = {.angle_deg = 0.0, .stays = true};
        cell.still_steps = std::min(cell.still_steps, 30);
        options_of<pbs::PbsOptions>(cell.spec).gravity_m_s2.setZero();
    }
    return cells;
}

void refuse_unknown_keys(const nlohmann::json& entry)
{
    static const std::set<std::string> known = {"of",      "undisturbed",  "deformer",    "overrides",
                                                "model",   "as_published", "still_steps", "nudge_m",
                                                "twisted", "few",          "sweeps",      "maps"};
    for (const auto& [key, value] : entry.items())
        if (!known.contains(key))
            throw std::logic_error("stability/cases.toml: nothing reads the key " + key + " of cells");
}

}  // namespace

void append(std::vector<StabilityCell>& cells, std::vector<StabilityCell> more)
{
    cells.insert(cells.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::vector<StabilityCell> stability_cells(const std::string& list, const std::string& body)
{
    using Names = std::vector<std::string>;
    std::vector<StabilityCell> cells;
    for (const nlohmann::json& entry : document().at("cells")) {
        if (entry.at("of") != list) continue;
        refuse_unknown_keys(entry);
        if (const std::string judged = entry.value("undisturbed", ""); !judged.empty()) {
            append(cells, undisturbed(judged == list ? cells : stability_cells(judged, body)));
            continue;
        }
        const Draft base = base_of(entry, body);
        const bool few = entry.value("few", false);
        for (const std::string& sweep : entry.value("sweeps", Names()))
            for (Draft& draft : varied(base, sweep_named(sweep), few)) cells.push_back(finished(std::move(draft)));
        for (const Names& map : entry.value("maps", std::vector<Names>()))
            for (Draft& draft : map_of(base, sweep_named(map.at(0)), sweep_named(map.at(1)), few))
                cells.push_back(finished(std::move(draft)));
    }
    return cells;
}

std::vector<StartRow> starts_not_applicable()
{
    std::vector<StartRow> rows;
    for (const nlohmann::json& entry : document().at("without_start")) {
        StartRow row{.body = StabilityCell().body, .model = entry.at("model")};
        row.precision = traits_of(default_spec(row.model)).precision;
        row.outcome = StartOutcome::not_applicable;
        row.reason = entry.at("reason");
        rows.push_back(row);
    }
    return rows;
}

}  // namespace experiments
