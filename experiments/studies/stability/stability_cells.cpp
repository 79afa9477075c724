#include "experiments/studies/stability/stability_cells.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/solver/options.hpp"

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
    cell.disturbance.start = static_cast<Start>(std::lround(value));
    cell.named = name_of(cell.disturbance.start);
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

namespace {

pbs::PbsOptions& pbs_of(StabilityCell& cell)
{
    return options_of<pbs::PbsOptions>(cell.spec);
}

void set_k_stretch(StabilityCell& cell, double k)
{
    pbs_of(cell).k_stretch = k;
    if (pbs_of(cell).jiggle) pbs_of(cell).jiggle->k_stretch = k;
}

void set_form(StabilityCell& cell, pbs::VolumeForm form)
{
    pbs_of(cell).volume_form = form;
    cell.named = name_of(form);
}

void set_order(StabilityCell& cell, double value)
{
    pbs_of(cell).order = value == 1.0 ? pbs::Order::plain : pbs::Order::grouped;
    cell.named = name_of(pbs_of(cell).order);
}

void set_no_time_step(StabilityCell& cell, double time_step_s)
{
    set_time_step(cell, time_step_s);
    cell.named = "not_used";
}

void set_own_time_step(StabilityCell& cell, double time_step_s)
{
    cell.time_step_s = time_step_s;  // by which it is counted
    auto& options = options_of<pbs::AuthorOptions>(cell.spec);
    options.time_step_s = time_step_s;
    options.gravity_m_s2.y() = -g_m_s2;
}

void set_chebyshev(StabilityCell& cell, double rho)
{
    cell.spec = with_option(with_option(cell.spec, "acceleration", "chebyshev"), "rho", rho);
}

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

template <typename Options>
void set_iterations(StabilityCell& cell, double count)
{
    options_of<Options>(cell.spec).iterations = static_cast<int>(count);
}

// What the value of a sweep sets.
const std::map<std::string, Sweep::Set> setters = {
    {"time_step", set_time_step},
    {"clip_time_step", [](StabilityCell& cell, double value) { cell.time_step_s = value; }},
    {"no_time_step", set_no_time_step},
    {"own_time_step", set_own_time_step},
    {"twist", twist},
    {"bend_in_one_step", jump},
    {"teleport", [](StabilityCell& cell, double value) { cell.disturbance.teleport_m = value; }},
    {"start", start},
    {"slivers_height_kept", spoil<Defect::slivers>},
    {"needles_edge_kept", spoil<Defect::needles>},
    {"mass_ratio", [](StabilityCell& cell, double ratio) { cell.mass_ratio = ratio; }},
    {"held_end", [](StabilityCell& cell, double) { cell.held_end = true; }},
    {"k_stretch", set_k_stretch},
    {"k_volume", [](StabilityCell& cell, double k) { pbs_of(cell).k_volume = k; }},
    {"k_bind", [](StabilityCell& cell, double k) { pbs_of(cell).k_bind = k; }},
    {"order", set_order},
    {"printed_form", [](StabilityCell& cell, double value) { set_form(cell, static_cast<pbs::VolumeForm>(std::lround(value))); }},
    {"sign_k_bind",
     [](StabilityCell& cell, double k) {
         set_form(cell, pbs::VolumeForm::sign);
         pbs_of(cell).k_bind = k;
     }},
    {"iterations", set_iterations<pbs::PbsOptions>},
    {"gravity", set_gravity<pbs::PbsOptions>},
    {"xpbd_young", set_young<pbs::XpbdOptions>},
    {"xpbd_poisson", set_poisson<pbs::XpbdOptions>},
    {"xpbd_gravity", set_gravity<pbs::XpbdOptions>},
    {"xpbd_iterations", set_iterations<pbs::XpbdOptions>},
    {"fem_young", set_young<FemOptions>},
    {"fem_poisson", set_poisson<FemOptions>},
    {"fem_gravity", set_gravity<FemOptions>},
    {"flesh_poisson", [](StabilityCell& cell, double poisson) { cell.spec = with_option(cell.spec, "poisson", poisson); }},
    {"own_iterations", [](StabilityCell& cell, double count) { cell.spec = with_option(cell.spec, "iterations", int(count)); }},
    {"chebyshev_rho", set_chebyshev},
    {"omega", [](StabilityCell& cell, double omega) { cell.spec = with_option(cell.spec, "omega", omega); }},
    {"step_of_stiffness", [](StabilityCell& cell, double share) { cell.spec = with_option(cell.spec, "time_step", share); }}};

const nlohmann::json& document()
{
    static const nlohmann::json tables = cases_document("stability");
    return tables;
}

Sweep sweep_named(const std::string& name)
{
    const auto is_named = [&](const nlohmann::json& one) { return one.at("name") == name; };
    const nlohmann::json& all = document().at("sweep");
    const auto found = std::ranges::find_if(all, is_named);
    if (found == all.end()) throw std::logic_error("stability/cases.toml: no sweep " + name);
    return {found->value("factor", name),
            found->at("unit"),
            found->at("values"),
            found->value("more", std::vector<double>()),
            setters.at(found->value("sets", name)),
            found->value("as_published", true)};
}

const pbs::Vec3 downwards_m_s2(0.0, -g_m_s2, 0.0);

// f64: the paper's order, by which C08 is judged; f32: the default order, which is quicker.
void set_options(pbs::PbsOptions& options, const nlohmann::json& entry)
{
    options.precision = option_of<pbs::Precision>(entry.at("precision"));
    if (options.precision == pbs::Precision::f64 || entry.contains("order")) options.order = pbs::Order::plain;
    if (entry.contains("volume_form")) options.volume_form = option_of<pbs::VolumeForm>(entry.at("volume_form"));
    if (entry.value("jiggle", false)) options.jiggle = pbs::Jiggle{options.k_stretch};
    options.gravity_m_s2 = downwards_m_s2;
}

// Linear elements on the same tets. In time: generalised-alpha with stiffness-proportional damping, so that the body can come to rest.
void set_options(FemOptions& options, const nlohmann::json& entry)
{
    options.contact = false;  // which refuses a broken initial guess
    options.model = option_of<reference_fem::Model>(entry.at("material"));
    options.element_order = 1;
    options.gravity_m_s2 = downwards_m_s2;
    if (!entry.value("in_time", false)) return;
    options.dynamics = reference_fem::Dynamics::generalized_alpha;
    options.rayleigh_stiffness_s = 0.05;
}

DeformerSpec spec_of(const nlohmann::json& entry)
{
    DeformerSpec spec = default_spec(entry.at("kind"));
    if (options_if<pbs::PbsOptions>(spec)) {
        set_options(options_of<pbs::PbsOptions>(spec), entry);
        if (entry.value("jiggle", false)) spec.variant = "jiggle";
    } else if (options_if<FemOptions>(spec)) {
        set_options(options_of<FemOptions>(spec), entry);
        spec.name = spec.label = "fem_" + entry.value("material", "") + (entry.value("in_time", false) ? "_in_time" : "");
    } else if (options_if<pbs::XpbdOptions>(spec)) {
        auto& xpbd = options_of<pbs::XpbdOptions>(spec);
        xpbd.jiggle = true;  // the zone, the cost and gravity are those of PBS with jiggle
        xpbd.gravity_m_s2 = downwards_m_s2;
        if (entry.value("small_steps", false)) std::swap(xpbd.iterations, xpbd.substeps);
    }
    return spec;
}

// The cell from which the sweeps of an entry of [[cells]] vary one factor.
StabilityCell base_of(const nlohmann::json& entry, const std::string& body, bool full)
{
    StabilityCell cell;
    cell.body = body;
    cell.spec = spec_of(entry);
    cell.model = entry.value("model", cell.spec.name + (entry.value("jiggle", false) ? "_jiggle" : ""));
    const nlohmann::json& steps = entry.at("still_steps");
    cell.still_steps = steps.is_array() ? steps.at(full ? 1 : 0) : steps;
    cell.nudge_m = entry.value("nudge_m", 0.0);
    cell.as_published = entry.value("as_published", options_if<pbs::PbsOptions>(cell.spec) != nullptr);
    if (entry.value("twisted", false)) cell.disturbance.axis = pbs::Vec3::UnitX();
    return cell;
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
        pbs_of(cell).gravity_m_s2.setZero();
    }
    return cells;
}

void refuse_unknown_keys(const nlohmann::json& entry)
{
    static const std::set<std::string> known = {
        "of",    "undisturbed", "kind",    "precision", "jiggle",      "small_steps", "order",        "volume_form", "material", "in_time",
        "model", "still_steps", "nudge_m", "sweeps",    "full_sweeps", "maps",        "as_published", "short",       "twisted"};
    for (const auto& [key, value] : entry.items())
        if (!known.contains(key)) throw std::logic_error("stability/cases.toml: nothing reads the key " + key + " of cells");
}

}  // namespace

std::vector<StabilityCell> stability_cells(const std::string& list, bool full, const std::string& body)
{
    using Names = std::vector<std::string>;
    std::vector<StabilityCell> cells;
    for (const nlohmann::json& entry : document().at("cells")) {
        if (entry.at("of") != list) continue;
        refuse_unknown_keys(entry);
        if (const std::string judged = entry.value("undisturbed", ""); !judged.empty()) {
            append(cells, undisturbed(judged == list ? cells : stability_cells(judged, full, body)));
            continue;
        }
        const StabilityCell from = base_of(entry, body, full);
        const bool more = full && !entry.value("short", false);
        for (const std::string& sweep : entry.value("sweeps", Names())) append(cells, cells_of(sweep_named(sweep), from, more));
        for (const std::string& sweep : entry.value("full_sweeps", Names()))
            if (full) append(cells, cells_of(sweep_named(sweep), from, more));
        for (const Names& map : entry.value("maps", std::vector<Names>()))
            append(cells, cells_of_map(sweep_named(map.at(0)), sweep_named(map.at(1)), from, more));
    }
    return cells;
}

std::vector<StartRow> starts_not_applicable()
{
    std::vector<StartRow> rows;
    for (const nlohmann::json& entry : document().at("without_start")) {
        StartRow row{.body = "limb", .model = entry.at("model")};
        row.precision = traits_of(default_spec(row.model)).precision;
        row.outcome = StartOutcome::not_applicable;
        row.reason = entry.at("reason");
        rows.push_back(row);
    }
    return rows;
}

}  // namespace experiments
