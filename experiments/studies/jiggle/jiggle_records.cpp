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

namespace experiments {

using analysis::Columns;
using analysis::DampedOscillation;
using analysis::Interval;
using analysis::Measurement;
using analysis::within;

namespace {

const Columns<JiggleSetting> stiffness_columns = {{"k_stretch", &JiggleSetting::k_stretch}};
const Columns<JiggleSetting> solver_columns = MEMBER_COLUMNS(JiggleSetting, iterations, masses, k_bind);

const Columns<Interval> frequency_columns = {
    {"frequency_hz", &Interval::estimate}, {"frequency_low_hz", &Interval::low}, {"frequency_high_hz", &Interval::high}};
const Columns<Interval> damping_columns = {
    {"damping_ratio", &Interval::estimate}, {"damping_low", &Interval::low}, {"damping_high", &Interval::high}};
const Columns<DampedOscillation> swing_columns = within(&DampedOscillation::frequency_hz, frequency_columns) +
                                                 within(&DampedOscillation::damping_ratio, damping_columns) +
                                                 Columns<DampedOscillation>{{"explained", &DampedOscillation::explained}};

const Columns<JoltResponse> jolt_columns =
    within(&JoltResponse::swing, swing_columns) +
    MEMBER_COLUMNS(JoltResponse, peak_over_jolt, overshoot_over_jolt, left_over_peak, speed_growth, finished);

constexpr double first_young_pa = 1e5;         // of the reference, before its frequency is matched
constexpr double rayleigh_stiffness_s = 0.02;  // of the control with damping
constexpr int control_steps = 100, least_for_correlation = 4;

ResponseRow response_row(const JiggleSetting& setting, double young_pa, double time_step_s, const JoltResponse& response)
{
    return {std::isnan(young_pa) ? "pbs" : "nh_p1", setting, 1e3 * time_step_s, young_pa, name_of(response.swing.outcome), response};
}

std::vector<ZoneRow> zone_rows(const pbs::ZoneContents& zone)
{
    std::vector<ZoneRow> rows;
    for (const pbs::BoneInZone& bone : zone.bones)
        rows.push_back(
            {zone.share, zone.skin_share, static_cast<int>(zone.pieces.size()), static_cast<int>(zone.pieces.front().size()), bone});
    return rows;
}

Jolt jolt_at(const JoltCase& jolt_case, const JiggleSetting& setting)
{
    Jolt jolt = jolt_case.jolt;
    jolt.time_step_s = setting.time_step_s;
    return jolt;
}

struct JoltRecords {
    std::vector<ResponseRow> responses = {};
    std::vector<analysis::Measurement> measurements = {};
};

Measurement measurement(const std::string& quantity, const analysis::CaseKey& key, const Interval& value, const std::string& unit)
{
    return {"C09", quantity, key, value.estimate, value.low, value.high, unit};
}

Measurement exact_value(const std::string& quantity, const analysis::CaseKey& key, double value)
{
    return {"C09", quantity, key, value, value, value, "1"};
}

Interval over(const Interval& a, const Interval& b)
{
    return {a.estimate / b.estimate, a.low / b.high, a.high / b.low};
}

void add_reference(const JoltCase& jolt_case, const pbs::Character& character, const std::vector<int>& probe,
                   const MeasuredJiggle& measured, JoltRecords& records)
{
    const auto& own = measured.response;
    if (!own.swing.found()) return;
    const double hz = own.swing.frequency_hz.estimate;
    const auto reference = match_reference(character, dynamic_reference(first_young_pa), probe, jolt_at(jolt_case, measured.setting), hz);
    if (!reference) return;
    const auto& swing = reference->response.swing;
    records.responses.push_back(response_row(measured.setting, reference->young_pa, reference->time_step_s, reference->response));
    analysis::CaseKey at = key_of(character.name, measured.setting);
    at.reference = "nh_p1";
    at.young_pa = reference->young_pa;
    const double reach = own.overshoot_over_jolt / reference->response.overshoot_over_jolt;
    records.measurements.push_back(measurement("frequency_over_reference", at, over(own.swing.frequency_hz, swing.frequency_hz), "1"));
    records.measurements.push_back(exact_value("amplitude_over_reference", at, reach));
    records.measurements.push_back(measurement("damping_ratio_of_reference", at, swing.damping_ratio, "1"));
}

const Interval* frequency_at(const std::vector<MeasuredJiggle>& measured, const JiggleSetting& setting)
{
    const auto found = std::find_if(measured.begin(), measured.end(), [&](const auto& one) { return one.setting == setting; });
    return found != measured.end() && found->response.swing.found() ? &found->response.swing.frequency_hz : nullptr;
}

struct FrequencyRatio {
    JiggleSetting from;
    Interval ratio;
};

// The ratio of the frequency at each setting to the frequency at the setting from which it is changed.
std::vector<FrequencyRatio> ratios(const std::vector<MeasuredJiggle>& measured, void (*change)(JiggleSetting&))
{
    std::vector<FrequencyRatio> frequency_ratios;
    for (const MeasuredJiggle& jiggle : measured) {
        JiggleSetting changed = jiggle.setting;
        change(changed);
        const Interval *at = frequency_at(measured, jiggle.setting), *there = frequency_at(measured, changed);
        if (at && there) frequency_ratios.push_back({jiggle.setting, over(*there, *at)});
    }
    return frequency_ratios;
}

bool is_of_the_papers_solver(const JiggleSetting& setting)
{
    return setting.order == JiggleSetting{}.order && setting.precision == JiggleSetting{}.precision;
}

void add_share(std::vector<Measurement>& measurements, const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    std::vector<double> swings;  // 1 where it does
    for (const MeasuredJiggle& jiggle : measured)
        if (is_of_the_paper(jiggle.setting) && is_of_the_papers_solver(jiggle.setting)) swings.push_back(jiggle.response.swing.found());
    if (swings.empty()) return;
    measurements.push_back(exact_value("share_of_settings_that_swing", {.body = body}, analysis::mean(swings)));
    measurements.back().n = static_cast<int>(swings.size());
}

// key: with the body and the deformer.
void add_setting(std::vector<Measurement>& measurements, const analysis::CaseKey& key, const JoltResponse& response, bool of_the_paper)
{
    if (response.finished) measurements.push_back(exact_value("amplitude", key, response.overshoot_over_jolt));
    if (of_the_paper)
        measurements.push_back(exact_value("last_share_of_peak", key, response.finished ? response.left_over_peak : analysis::not_known));
    if (!response.swing.found()) return;
    const std::string damping = of_the_paper ? "damping_ratio" : "damping_ratio_in_other_readings";
    measurements.push_back(measurement(damping, key, response.swing.damping_ratio, "1"));
    measurements.push_back(measurement("frequency_hz", key, response.swing.frequency_hz, "Hz"));
}

// Those that differ from `from` in k_stretch alone, the smallest first.
std::vector<MeasuredJiggle> by_k_stretch(const std::vector<MeasuredJiggle>& measured, JiggleSetting from,
                                         bool (*is_known)(const JoltResponse&))
{
    std::vector<MeasuredJiggle> chosen;
    for (const MeasuredJiggle& jiggle : measured) {
        from.k_stretch = jiggle.setting.k_stretch;
        if (is_known(jiggle.response) && jiggle.setting == from) chosen.push_back(jiggle);
    }
    std::ranges::stable_sort(chosen, {}, [](const MeasuredJiggle& jiggle) { return jiggle.setting.k_stretch; });
    return chosen;
}

// A quantity at each stiffness: k_stretch, or Young's modulus.
struct Trend {
    std::vector<double> stiffness, value;
};

Trend trend_of(const std::vector<MeasuredJiggle>& measured, double (*value)(const JoltResponse&))
{
    Trend trend;
    for (const MeasuredJiggle& jiggle : measured) {
        trend.stiffness.push_back(jiggle.setting.k_stretch);
        trend.value.push_back(value(jiggle.response));
    }
    return trend;
}

double correlation_without(Trend trend, std::size_t left_out)
{
    for (std::vector<double>* numbers : {&trend.stiffness, &trend.value})
        if (left_out < numbers->size()) numbers->erase(numbers->begin() + static_cast<std::ptrdiff_t>(left_out));
    return analysis::rank_correlation(trend.stiffness, trend.value);
}

void add_correlation(std::vector<Measurement>& measurements, const std::string& quantity, const analysis::CaseKey& key, const Trend& trend)
{
    const std::size_t points = trend.value.size();
    if (points < std::size_t{least_for_correlation}) return;
    Measurement correlation = exact_value(quantity, key, correlation_without(trend, points));
    correlation.n = static_cast<int>(points);
    for (std::size_t left_out = 0; left_out < points; ++left_out) {
        const double without = correlation_without(trend, left_out);
        correlation.low = std::min(correlation.low, without);
        correlation.high = std::max(correlation.high, without);
    }
    measurements.push_back(correlation);
}

// NaN where nothing swings beyond its place at any stiffness.
void add_amplitudes(std::vector<Measurement>& measurements, const analysis::CaseKey& key, const Trend& amplitude)
{
    if (amplitude.value.size() < 2) return;
    const auto [least, most] = std::ranges::minmax(amplitude.value);
    measurements.push_back(exact_value("amplitude_ratio_over_k_stretch", key, most / least));
    add_correlation(measurements, "rank_correlation_of_amplitude_and_k_stretch", key, amplitude);
}

void add_frequencies(std::vector<Measurement>& measurements, const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    if (measured.size() < 2) return;
    add_correlation(measurements, "rank_correlation_of_frequency_and_k_stretch", {.body = body},
                    trend_of(measured, [](const JoltResponse& response) { return response.swing.frequency_hz.estimate; }));
    const MeasuredJiggle &smallest = measured.front(), &largest = measured.back();
    const analysis::CaseKey key = {.body = body, .k_stretch = smallest.setting.k_stretch, .k_stretch_to = largest.setting.k_stretch};
    measurements.push_back(measurement("frequency_ratio_over_k_stretch", key,
                                       over(largest.response.swing.frequency_hz, smallest.response.swing.frequency_hz), "1"));
}

// LBS at each k_stretch, which it does not have; the author's later code; and finite elements in time: with damping at each Young's
// modulus, without it at the first, at which those with damping come to rest within the steps. Linear elements suffice where nothing turns,
// and average acceleration adds no damping of its own.
void add_controls(const JoltCase& jolt_case, const pbs::Character& character, const std::vector<int>& probe,
                  std::vector<Measurement>& measurements)
{
    Jolt jolt = jolt_case.jolt;
    jolt.steps = control_steps;
    Trend of_lbs, of_fem;
    for (const JiggleSetting& setting : jolt_case.settings) {
        if (setting != JiggleSetting{.k_stretch = setting.k_stretch}) continue;
        of_lbs.stiffness.push_back(setting.k_stretch);
        of_lbs.value.push_back(jolt_response(character, default_spec("lbs"), probe, jolt).overshoot_over_jolt);
    }
    add_amplitudes(measurements, {.body = character.name, .deformer = "lbs"}, of_lbs);
    DeformerSpec author = default_spec("pbs_author");
    options_of<pbs::AuthorOptions>(author).gravity_m_s2.setZero();
    add_setting(measurements, {.body = character.name, .deformer = "pbs_author"}, jolt_response(character, author, probe, jolt), true);
    const auto response = [&](double young_pa, double damping_s) {
        DeformerSpec spec = dynamic_reference(young_pa);
        auto& options = options_of<FemOptions>(spec);
        options.model = reference_fem::Model::linear;
        options.dynamics = reference_fem::Dynamics::newmark;
        options.rayleigh_stiffness_s = damping_s;
        return jolt_response(character, spec, probe, jolt);
    };
    analysis::CaseKey key = {.body = character.name, .deformer = "fem_undamped"};
    for (const double young_pa : jolt_case.young_pa) {
        const bool is_first = young_pa == jolt_case.young_pa.front();
        key.young_pa = young_pa;
        if (is_first) add_setting(measurements, key, response(young_pa, 0.0), true);
        key.deformer = "fem_damped";
        const JoltResponse damped = response(young_pa, rayleigh_stiffness_s);
        if (is_first) add_setting(measurements, key, damped, true);
        if (!damped.finished) continue;
        if (!is_first) measurements.push_back(exact_value("amplitude", key, damped.overshoot_over_jolt));
        of_fem.stiffness.push_back(young_pa);
        of_fem.value.push_back(damped.overshoot_over_jolt);
    }
    add_amplitudes(measurements, {.body = character.name, .deformer = "fem_damped"}, of_fem);
}

void add_half_step(std::vector<Measurement>& measurements, const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    const std::vector<FrequencyRatio> halvings = ratios(measured, [](JiggleSetting& setting) { setting.time_step_s /= 2.0; });
    if (halvings.empty()) return;
    Measurement half =
        exact_value("frequency_ratio_at_half_time_step", key_of(body, halvings.front().from), halvings.front().ratio.estimate);
    for (const FrequencyRatio& halving : halvings) half.low = std::min(half.low, halving.ratio.estimate);
    for (const FrequencyRatio& halving : halvings) half.high = std::max(half.high, halving.ratio.estimate);
    half.n = static_cast<int>(halvings.size());
    measurements.push_back(half);
}

// The vertices of a stop's bone in the jiggling zone.
std::vector<int> probe_of(const StopCase& stop, const pbs::Character& character)
{
    const std::vector<bool> zone = pbs::jiggle_zone(character.binding);
    const int bone = pbs::find_bone(character.skeleton, stop.bone);
    std::vector<int> probe;
    for (std::size_t v = 0; v < zone.size(); ++v)
        if (zone[v] && character.binding.bone[v] == bone) probe.push_back(static_cast<int>(v));
    if (probe.empty())
        throw pbs::InputError("jiggle/cases.toml", 0, "stops", stop.bone, "expected a bone with vertices in the jiggling zone");
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
    for (const double k : stop.k_stretch)
        deformers.push_back({jiggling(spec_of(stop.scene, "pbs"), {.k_stretch = k}), {"pbs", k, none, none}});
    DeformerSpec flesh = spec_of(stop.scene, stop.scene.reference), xpbd = spec_of(stop.scene, "xpbd");
    auto& fem = options_of<FemOptions>(flesh);
    auto& own = options_of<pbs::XpbdOptions>(xpbd);
    own.young_pa = fem.young_pa;
    own.poisson = fem.poisson;
    own.density_kg_m3 = fem.density_kg_m3;
    own.jiggle = true;
    for (const int finer : {1, stop.finer_steps}) deformers.push_back({xpbd, {"xpbd", none, own.young_pa, none}, finer});
    fem.dynamics = reference_fem::Dynamics::generalized_alpha;
    fem.contact = false;  // generalised alpha has none
    for (const double damping_s : stop.rayleigh_stiffness_s) {
        fem.rayleigh_stiffness_s = damping_s;
        deformers.push_back({flesh, {flesh.label, none, fem.young_pa, damping_s}, stop.finer_steps});
    }
    return deformers;
}

// The response of a deformer. Nothing is fitted where it does not swing.
StopRow stop_row(const StopCase& stop, const pbs::Character& character, const std::vector<int>& probe, const StoppedDeformer& deformer)
{
    MotionSpec motion = stop.scene.motion;
    motion.frames *= deformer.finer;
    motion.rate_hz *= deformer.finer;
    motion.time_step_s /= deformer.finer;
    const int still_steps = static_cast<int>(std::lround(stop.still_s / motion.time_step_s));
    StopRow row = deformer.described;
    row.response = stop_response(character, deformer.spec, probe, make_motion(motion, character.skeleton, stop.scene.file), still_steps);
    row.time_step_ms = 1e3 * motion.time_step_s;
    DampedOscillation& swing = row.response.swing;
    row.outcome = name_of(swing.outcome);
    if (!swing.found()) swing.frequency_hz = swing.damping_ratio = {analysis::not_known, analysis::not_known, analysis::not_known};
    return row;
}

}  // namespace

const Columns<ResponseRow> response_columns =
    Columns<ResponseRow>{{"deformer", &ResponseRow::deformer}} + within(&ResponseRow::setting, stiffness_columns) +
    Columns<ResponseRow>{{"time_step_ms", &ResponseRow::time_step_ms}} + within(&ResponseRow::setting, solver_columns) +
    MEMBER_COLUMNS(ResponseRow, young_pa, outcome) + within(&ResponseRow::response, jolt_columns);

const Columns<ZoneRow> zone_columns = MEMBER_COLUMNS(ZoneRow, share_of_vertices, share_on_skin, pieces, largest_piece) +
                                      within(&ZoneRow::bone, Columns<pbs::BoneInZone>{{"bone", &pbs::BoneInZone::name},
                                                                                      {"share_of_zone", &pbs::BoneInZone::share_of_zone},
                                                                                      {"share_of_bone", &pbs::BoneInZone::share_of_bone}});

RECORD_SETTINGS(Jolt, direction, length_m, time_step_s, still_steps, steps)

RECORD_SETTINGS_AND(JoltCase,
                    .constant("reference", {{"deformer", "neo-Hookean, linear elements, generalised alpha"},
                                            {"first_young_pa", first_young_pa},
                                            {"steps_a_period", reference_steps_a_period},
                                            {"periods", reference_periods}})
                        .constant("controls", {{"rayleigh_stiffness_s", rayleigh_stiffness_s}, {"steps", control_steps}}),
                    scene, jolt, settings, with_reference, young_pa)

std::string record_jolts(const JoltCase& jolt_case, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(jolt_case.scene.character);
    const pbs::ZoneContents zone = zone_contents(character);
    JoltRecords records;
    std::vector<MeasuredJiggle> measured;
    std::string breakdown;
    for (const JiggleSetting& setting : jolt_case.settings) {
        const DeformerSpec spec = jiggling(spec_of(jolt_case.scene, "pbs"), setting);
        measured.push_back({setting, jolt_response(character, spec, zone.pieces.front(), jolt_at(jolt_case, setting))});
        const JoltResponse& response = measured.back().response;
        if (!response.finished) breakdown += text_of(setting) + ". ";
        if (!is_of_the_papers_solver(setting)) continue;
        records.responses.push_back(response_row(setting, analysis::not_known, setting.time_step_s, response));
    }
    if (jolt_case.with_reference)
        for (const MeasuredJiggle& jiggle : measured) add_reference(jolt_case, character, zone.pieces.front(), jiggle, records);
    else {
        records.measurements = jiggle_values(character.name, measured);
        add_controls(jolt_case, character, zone.pieces.front(), records.measurements);
    }
    table_of(zone_columns, zone_rows(zone)).write(analysis::path_in(folder, "zone.csv"));
    table_of(response_columns, records.responses).write(analysis::path_in(folder, "responses.csv"));
    analysis::measurement_table(records.measurements).write(analysis::path_in(folder, "measurements.csv"));
    return breakdown;
}

const Columns<StopRow> stop_columns = MEMBER_COLUMNS(StopRow, deformer, k_stretch, young_pa, rayleigh_stiffness_s, time_step_ms, outcome) +
                                      within(&StopRow::response, Columns<JoltResponse>{{"path_m", &JoltResponse::path_m},
                                                                                       {"rest_over_path", &JoltResponse::rest_over_jolt},
                                                                                       {"peak_over_path", &JoltResponse::peak_over_jolt}} +
                                                                     within(&JoltResponse::swing, swing_columns) +
                                                                     MEMBER_COLUMNS(JoltResponse, settling_s, left_over_peak, finished));

RECORD_SETTINGS_AND(StopCase,
                    .constant("pbs", to_json(JiggleSetting{}))
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

std::vector<Measurement> jiggle_values(const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    std::vector<Measurement> measurements;
    add_share(measurements, body, measured);
    for (const MeasuredJiggle& jiggle : measured)
        add_setting(measurements, key_of(body, jiggle.setting), jiggle.response, is_of_the_paper(jiggle.setting));
    for (const JiggleSetting& from : {JiggleSetting{}, JiggleSetting{.order = pbs::Order::ordered, .precision = pbs::Precision::f32}}) {
        const auto finished = by_k_stretch(measured, from, [](const JoltResponse& response) { return response.finished; });
        add_amplitudes(measurements,
                       {.body = body,
                        .deformer = "pbs",
                        .order = name_of(from.order),
                        .precision = name_of(from.precision),
                        .masses = name_of(from.masses)},
                       trend_of(finished, [](const JoltResponse& response) { return response.overshoot_over_jolt; }));
    }
    add_frequencies(measurements, body, by_k_stretch(measured, {}, [](const JoltResponse& response) { return response.swing.found(); }));
    add_half_step(measurements, body, measured);
    const std::vector<FrequencyRatio> doublings = ratios(measured, [](JiggleSetting& setting) { setting.iterations *= 2; });
    for (const auto& [from, ratio] : doublings)
        measurements.push_back(measurement("frequency_ratio_at_twice_iterations", key_of(body, from), ratio, "1"));
    return measurements;
}

}  // namespace experiments
