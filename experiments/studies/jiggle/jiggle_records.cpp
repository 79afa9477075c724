#include "experiments/studies/jiggle/jiggle_records.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace experiments {

using analysis::Columns;
using analysis::DampedOscillation;
using analysis::Interval;
using analysis::Measurement;
using analysis::within;

namespace {

const Columns<DampedOscillation> outcome_columns = {{"outcome", &DampedOscillation::outcome}};
const Columns<Interval> frequency_columns = {{"frequency_hz", &Interval::estimate},
                                             {"frequency_low_hz", &Interval::low},
                                             {"frequency_high_hz", &Interval::high}};
const Columns<Interval> damping_columns = {
    {"damping_ratio", &Interval::estimate}, {"damping_low", &Interval::low}, {"damping_high", &Interval::high}};
const Columns<DampedOscillation> swing_columns =
    within(&DampedOscillation::frequency_hz, frequency_columns) +
    within(&DampedOscillation::damping_ratio, damping_columns) +
    Columns<DampedOscillation>{{"explained", &DampedOscillation::explained}};

// Of the jolt: flesh that LBS carries along moves by rounding, some 1e-5, which is no swing.
constexpr double least_answer = 1e-3;
constexpr double first_young_pa = 1e5;         // of the reference, before its frequency is matched
constexpr double rayleigh_stiffness_s = 0.02;  // of the control with damping
constexpr int control_steps = 100;
constexpr int reference_steps_a_period = 24, reference_periods = 4;  // of the wanted frequency

std::vector<ZoneRow> zone_rows(const pbs::ZoneContents& zone)
{
    std::vector<ZoneRow> rows;
    for (const pbs::BoneInZone& bone : zone.bones)
        rows.push_back({zone.share, zone.skin_share, static_cast<int>(zone.pieces.size()),
                        static_cast<int>(zone.pieces.front().size()), bone});
    return rows;
}

Measurement measurement(const std::string& quantity, const analysis::CaseKey& key, const Interval& value,
                        const std::string& unit = "1")
{
    return {"C09", quantity, key, value.estimate, value.low, value.high, unit};
}

Measurement exact_value(const std::string& quantity, const analysis::CaseKey& key, double value)
{
    return measurement(quantity, key, {value, value, value});
}

// key: with the body, the deformer and the setting.
void add_values(std::vector<Measurement>& measurements, const analysis::CaseKey& key, const JoltResponse& response)
{
    const bool is_of_the_paper = !key.k_bind && key.masses != name_of(pbs::Masses::lumped);
    if (response.finished) measurements.push_back(exact_value("amplitude", key, response.overshoot_over_jolt));
    if (is_of_the_paper)
        measurements.push_back(
            exact_value("last_share_of_peak", key, response.finished ? response.left_over_peak : analysis::not_known));
    if (!response.swing.found()) return;
    const std::string damping = is_of_the_paper ? "damping_ratio" : "damping_ratio_in_other_readings";
    measurements.push_back(measurement(damping, key, response.swing.damping_ratio));
    measurements.push_back(measurement("frequency_hz", key, response.swing.frequency_hz, "Hz"));
}

// The response of PBS at each setting.
std::vector<ResponseRow> responses_of_pbs(const JoltCase& jolt_case, const pbs::Character& character,
                                          const std::vector<int>& probe)
{
    std::vector<ResponseRow> rows;
    for (const Overrides& setting : jolt_case.settings) {
        const Scene scene = scene_of(jolt_case, setting);
        Jolt jolt = jolt_case.jolt;
        jolt.time_step_s = scene.motion.time_step_s;
        rows.push_back(setting_of(scene));
        JoltResponse& response = rows.back().response;
        response = jolt_response(character, spec_of(scene, "pbs"), probe, jolt);
        if (response.peak_over_jolt < least_answer) response.swing = {};
    }
    return rows;
}

// Neo-Hookean, linear elements, generalised alpha.
DeformerSpec dynamic_reference(double young_pa)
{
    DeformerSpec spec = default_spec("fem");
    auto& options = options_of<FemOptions>(spec);
    options.model = reference_fem::Model::neo_hookean;
    options.element_order = 1;
    options.dynamics = reference_fem::Dynamics::generalized_alpha;
    options.young_pa = young_pa;
    return spec;
}

// The same flesh as an elastic body in time, with the Young's modulus with which it swings as fast as PBS does at one
// setting; damping and amplitude can then be compared. The frequency is proportional to sqrt(E): E is chosen by that of
// a first modulus, then solved again. Nothing where one of them does not swing.
std::optional<ResponseRow> reference_row(const JoltCase& jolt_case, const pbs::Character& character,
                                         const std::vector<int>& probe, const ResponseRow& own)
{
    const DampedOscillation& swing = own.response.swing;
    if (!swing.found()) return std::nullopt;
    Jolt jolt = jolt_case.jolt;
    jolt.time_step_s = 1.0 / (reference_steps_a_period * swing.frequency_hz.estimate);
    jolt.steps = reference_steps_a_period * reference_periods;
    ResponseRow row = own;
    row.deformer = "nh_p1";
    row.time_step_ms = 1e3 * jolt.time_step_s;
    row.young_pa = first_young_pa;
    for (const bool is_matched : {false, true}) {
        if (is_matched)
            row.young_pa *= std::pow(swing.frequency_hz.estimate / row.response.swing.frequency_hz.estimate, 2);
        row.response = jolt_response(character, dynamic_reference(row.young_pa), probe, jolt);
        if (!row.response.finished || !row.response.swing.found()) return std::nullopt;
    }
    return row;
}

void add_over_reference(std::vector<Measurement>& measurements, const std::string& body, const ResponseRow& own,
                        const ResponseRow& reference)
{
    const DampedOscillation &own_swing = own.response.swing, &swing = reference.response.swing;
    analysis::CaseKey at = key_of(body, own);
    at.reference = reference.deformer;
    at.young_pa = reference.young_pa;
    measurements.push_back(
        measurement("frequency_over_reference", at, analysis::ratio(own_swing.frequency_hz, swing.frequency_hz)));
    measurements.push_back(exact_value("amplitude_over_reference", at,
                                       own.response.overshoot_over_jolt / reference.response.overshoot_over_jolt));
    measurements.push_back(measurement("damping_ratio_of_reference", at, swing.damping_ratio));
}

// LBS at each k_stretch, which it does not have; the author's later code; and finite elements in time: with damping at
// each Young's modulus, without it at the first, at which those with damping come to rest within the steps. Linear
// elements suffice where nothing turns, and average acceleration adds no damping of its own.
void add_controls(const JoltCase& jolt_case, const pbs::Character& character, const std::vector<int>& probe,
                  const std::vector<ResponseRow>& rows, std::vector<Measurement>& measurements)
{
    Jolt jolt = jolt_case.jolt;
    jolt.steps = control_steps;
    for (const ResponseRow& row : rows) {
        if (key_of("", row) != key_of("", {.k_stretch = row.k_stretch})) continue;
        const analysis::CaseKey key = {.body = character.name, .deformer = "lbs", .k_stretch = row.k_stretch};
        measurements.push_back(exact_value(
            "amplitude", key, jolt_response(character, default_spec("lbs"), probe, jolt).overshoot_over_jolt));
    }
    DeformerSpec author = default_spec("pbs_author");
    options_of<pbs::AuthorOptions>(author).gravity_m_s2.setZero();
    add_values(measurements, {.body = character.name, .deformer = "pbs_author"},
               jolt_response(character, author, probe, jolt));
    const auto response = [&](double young_pa, double damping_s) {
        DeformerSpec spec = dynamic_reference(young_pa);
        auto& options = options_of<FemOptions>(spec);
        options.model = reference_fem::Model::linear;
        options.dynamics = reference_fem::Dynamics::newmark;
        options.rayleigh_stiffness_s = damping_s;
        return jolt_response(character, spec, probe, jolt);
    };
    for (const double young_pa : jolt_case.young_pa) {
        const bool is_first = young_pa == jolt_case.young_pa.front();
        const analysis::CaseKey undamped = {.body = character.name, .deformer = "fem_undamped", .young_pa = young_pa},
                                damped = {.body = character.name, .deformer = "fem_damped", .young_pa = young_pa};
        if (is_first) add_values(measurements, undamped, response(young_pa, 0.0));
        const JoltResponse with_damping = response(young_pa, rayleigh_stiffness_s);
        if (is_first)
            add_values(measurements, damped, with_damping);
        else if (with_damping.finished)
            measurements.push_back(exact_value("amplitude", damped, with_damping.overshoot_over_jolt));
    }
}

// stop.csv
struct StopRow {
    std::string deformer;
    double k_stretch = 0.0, young_pa = 0.0, rayleigh_stiffness_s = 0.0;  // not a number where the deformer has none
    double time_step_ms = 0.0;
    JoltResponse response{};
};

const Columns<StopRow> stop_columns =
    MEMBER_COLUMNS(StopRow, deformer, k_stretch, young_pa, rayleigh_stiffness_s, time_step_ms) +
    within(&StopRow::response, within(&JoltResponse::swing, outcome_columns) +
                                   Columns<JoltResponse>{{"path_m", &JoltResponse::path_m},
                                                         {"rest_over_path", &JoltResponse::rest_over_jolt},
                                                         {"peak_over_path", &JoltResponse::peak_over_jolt}} +
                                   within(&JoltResponse::swing, swing_columns) +
                                   MEMBER_COLUMNS(JoltResponse, settling_s, left_over_peak, finished));

// The vertices of a stop's bone in the jiggling zone.
std::vector<int> probe_of(const StopCase& stop, const pbs::Character& character)
{
    const std::vector<bool> zone = pbs::jiggle_zone(character.binding);
    const int bone = pbs::find_bone(character.skeleton, stop.bone);
    std::vector<int> probe;
    for (std::size_t v = 0; v < zone.size(); ++v)
        if (zone[v] && character.binding.bone[v] == bone) probe.push_back(static_cast<int>(v));
    if (probe.empty())
        throw pbs::InputError("jiggle/cases.toml", 0, "stops", stop.bone,
                              "expected a bone with vertices in the jiggling zone");
    return probe;
}

// A deformer that stops, with the columns of stop.csv that describe it, and its steps for each step of PBS.
struct StoppedDeformer {
    DeformerSpec spec;
    StopRow described;
    int finer = 1;
};

// PBS with each stiffness, XPBD with the material of the reference, and the reference in time with each damping.
std::vector<StoppedDeformer> stopped_deformers(const StopCase& stop)
{
    constexpr double none = analysis::not_known;
    std::vector<StoppedDeformer> deformers;
    for (const double k : stop.k_stretch) {
        DeformerSpec jiggling = spec_of(stop.scene, "pbs");
        options_of<pbs::PbsOptions>(jiggling).jiggle.value().k_stretch = k;
        deformers.push_back({jiggling, {jiggling.label, k, none, none}});
    }
    DeformerSpec flesh = spec_of(stop.scene, stop.scene.reference), xpbd = spec_of(stop.scene, "xpbd");
    auto& fem = options_of<FemOptions>(flesh);
    auto& own = options_of<pbs::XpbdOptions>(xpbd);
    own.young_pa = fem.young_pa;
    own.poisson = fem.poisson;
    own.density_kg_m3 = fem.density_kg_m3;
    own.jiggle = true;
    for (const int finer : {1, stop.finer_steps})
        deformers.push_back({xpbd, {"xpbd", none, own.young_pa, none}, finer});
    fem.dynamics = reference_fem::Dynamics::generalized_alpha;
    fem.contact = false;  // generalised alpha has none
    for (const double damping_s : stop.rayleigh_stiffness_s) {
        fem.rayleigh_stiffness_s = damping_s;
        deformers.push_back({flesh, {flesh.label, none, fem.young_pa, damping_s}, stop.finer_steps});
    }
    return deformers;
}

// The response of a deformer. Where it does not swing, no frequency is on record.
StopRow stop_row(const StopCase& stop, const pbs::Character& character, const std::vector<int>& probe,
                 const StoppedDeformer& deformer)
{
    MotionSpec motion = stop.scene.motion;
    motion.frames *= deformer.finer;
    motion.rate_hz *= deformer.finer;
    motion.time_step_s /= deformer.finer;
    const int still_steps = static_cast<int>(std::lround(stop.still_s / motion.time_step_s));
    StopRow row = deformer.described;
    row.response = stop_response(character, deformer.spec, probe,
                                 make_motion(motion, character.skeleton, stop.scene.file), still_steps);
    row.time_step_ms = 1e3 * motion.time_step_s;
    DampedOscillation& swing = row.response.swing;
    if (!swing.found())
        swing.frequency_hz = swing.damping_ratio = {analysis::not_known, analysis::not_known, analysis::not_known};
    return row;
}

}  // namespace

const Columns<ResponseRow> response_columns =
    MEMBER_COLUMNS(ResponseRow, deformer, k_stretch, time_step_ms, iterations, masses, k_bind, young_pa) +
    within(&ResponseRow::response, within(&JoltResponse::swing, outcome_columns + swing_columns) +
                                       MEMBER_COLUMNS(JoltResponse, peak_over_jolt, overshoot_over_jolt, left_over_peak,
                                                      speed_growth, finished));

const Columns<ZoneRow> zone_columns =
    MEMBER_COLUMNS(ZoneRow, share_of_vertices, share_on_skin, pieces, largest_piece) +
    within(&ZoneRow::bone, Columns<pbs::BoneInZone>{{"bone", &pbs::BoneInZone::name},
                                                    {"share_of_zone", &pbs::BoneInZone::share_of_zone},
                                                    {"share_of_bone", &pbs::BoneInZone::share_of_bone}});

RECORD_SETTINGS(Jolt, direction, length_m, time_step_s, still_steps, steps)

RECORD_SETTINGS_AND(JoltCase,
                    .constant("reference", {{"deformer", "neo-Hookean, linear elements, generalised alpha"},
                                            {"first_young_pa", first_young_pa},
                                            {"steps_a_period", reference_steps_a_period},
                                            {"periods", reference_periods}})
                        .constant("controls",
                                  {{"rayleigh_stiffness_s", rayleigh_stiffness_s}, {"steps", control_steps}}),
                    scene, overrides, settings, jolt, with_reference, young_pa)

Scene scene_of(const JoltCase& jolt_case, Overrides setting)
{
    setting.insert(setting.begin(), jolt_case.overrides.begin(), jolt_case.overrides.end());
    return read_scene(jolt_case.scene, setting);
}

std::string record_jolts(const JoltCase& jolt_case, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(scene_of(jolt_case).character);
    const pbs::ZoneContents zone = zone_contents(character);
    const std::vector<int>& probe = zone.pieces.front();
    std::vector<ResponseRow> rows = responses_of_pbs(jolt_case, character, probe), references;
    std::vector<Measurement> measured;
    if (jolt_case.with_reference) {
        for (const ResponseRow& row : rows)
            if (const auto reference = reference_row(jolt_case, character, probe, row)) {
                references.push_back(*reference);
                add_over_reference(measured, character.name, row, *reference);
            }
    } else {
        measured = response_values(character.name, rows);
        add_controls(jolt_case, character, probe, rows, measured);
        std::ranges::move(jiggle_conclusions(measured), std::back_inserter(measured));
    }
    std::string breakdown;
    for (const ResponseRow& row : rows)
        if (!row.response.finished) breakdown += text_of(key_of(character.name, row)) + ". ";
    std::erase_if(rows, [](const ResponseRow& row) {
        return row.order != ResponseRow().order || row.precision != ResponseRow().precision;
    });
    rows.insert(rows.end(), references.begin(), references.end());
    table_of(zone_columns, zone_rows(zone)).write(analysis::path_in(folder, "zone.csv"));
    table_of(response_columns, rows).write(analysis::path_in(folder, "responses.csv"));
    analysis::measurement_table(measured).write(analysis::path_in(folder, "measurements.csv"));
    return breakdown;
}

RECORD_SETTINGS_AND(StopCase,
                    .constant("finite_elements", {{"dynamics", "generalized_alpha"}, {"contact", false}})
                        .constant("settled_share", settled_share),
                    scene, bone, k_stretch, rayleigh_stiffness_s, finer_steps, still_s)

std::string record_stop(const StopCase& stop, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(stop.scene.character);
    const std::vector<int> probe = probe_of(stop, character);
    std::vector<StopRow> rows;
    std::string breakdown;
    for (const StoppedDeformer& deformer : stopped_deformers(stop)) {
        const StopRow& row = rows.emplace_back(stop_row(stop, character, probe, deformer));
        if (!row.response.finished) breakdown += fmt::format("{} in steps of {} ms. ", row.deformer, row.time_step_ms);
    }
    table_of(stop_columns, rows).write(analysis::path_in(folder, "stop.csv"));
    return breakdown;
}

ResponseRow setting_of(const Scene& scene)
{
    const auto& options = options_of<pbs::PbsOptions>(spec_of(scene, "pbs"));
    return {.k_stretch = options.jiggle.value().k_stretch,
            .time_step_ms = 1e3 * scene.motion.time_step_s,
            .iterations = options.iterations,
            .masses = name_of(options.masses),
            .k_bind = options.jiggle->k_bind.value_or(options.k_bind),
            .order = name_of(options.order),
            .precision = name_of(options.precision)};
}

analysis::CaseKey key_of(const std::string& body, const ResponseRow& row)
{
    analysis::CaseKey key = {.body = body,
                             .deformer = row.deformer,
                             .order = row.order,
                             .precision = row.precision,
                             .k_stretch = row.k_stretch,
                             .masses = row.masses,
                             .iterations = row.iterations,
                             .time_step_s = row.time_step_ms / 1e3};
    if (row.k_bind < 1.0) key.k_bind = row.k_bind;
    return key;
}

std::vector<Measurement> response_values(const std::string& body, const std::vector<ResponseRow>& rows)
{
    std::vector<Measurement> measured;
    for (const ResponseRow& row : rows) add_values(measured, key_of(body, row), row.response);
    return measured;
}

std::vector<Measurement> jiggle_values(const std::string& body, const std::vector<ResponseRow>& rows)
{
    std::vector<Measurement> values = response_values(body, rows);
    std::ranges::move(jiggle_conclusions(values), std::back_inserter(values));
    return values;
}

}  // namespace experiments
