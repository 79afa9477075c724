#include "experiments/studies/jiggle/jiggle_records.hpp"

#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "analysis/records/csv_table.hpp"
#include "analysis/statistics.hpp"
#include "experiments/scene/motion_case.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "analysis/records/folder_files.hpp"
#include "experiments/studies/jiggle/jiggle_figures.hpp"
#include "experiments/studies/jiggle/jiggle_reference.hpp"
#include "experiments/studies/jiggle/jiggle_zone_contents.hpp"
#include "experiments/studies/jiggle/walk_response.hpp"

#include <fmt/format.h>

#include <cmath>

namespace experiments {
namespace {

using analysis::CsvTable;

constexpr double first_young_pa = 1e5;  // of the reference, before it is matched

CsvTable response_table()
{
    return CsvTable(
        {"deformer",  "k_stretch",      "time_step_ms",        "iterations",        "masses",        "k_bind",      "young_pa",
         "outcome",   "frequency_hz",   "frequency_low_hz",    "frequency_high_hz", "damping_ratio", "damping_low", "damping_high",
         "explained", "peak_over_jolt", "overshoot_over_jolt", "left_over_peak",    "speed_growth",  "finished"});
}

// young_pa: of the reference; not a number for pbs.
void add_response(CsvTable& table, const JiggleSetting& setting, double young_pa, double time_step_s, const JoltResponse& response)
{
    const auto& swing = response.swing;
    const auto &hz = swing.frequency_hz, &damping = swing.damping_ratio;
    table.add_row({std::isnan(young_pa) ? "pbs" : "snh_p1",
                   setting.k_stretch,
                   1e3 * time_step_s,
                   setting.iterations,
                   name_of(setting.masses),
                   setting.k_bind,
                   young_pa,
                   name_of(swing.outcome),
                   hz.estimate,
                   hz.low,
                   hz.high,
                   damping.estimate,
                   damping.low,
                   damping.high,
                   swing.explained,
                   response.peak_over_jolt,
                   response.overshoot_over_jolt,
                   response.left_over_peak,
                   response.speed_growth,
                   static_cast<int>(response.finished)});
}

void add_series(CsvTable& table, const std::string& name, double time_step_s, const JoltResponse& response)
{
    for (std::size_t i = 0; i < response.excursion_m.size(); ++i)
        table.add_row({name, static_cast<double>(i + 1) * time_step_s, response.excursion_m[i], response.speed_rms_m_s[i]});
}

void write_zone(const std::string& folder, const ZoneContents& zone)
{
    CsvTable table({"share_of_vertices", "share_on_skin", "pieces", "largest_piece", "bone", "share_of_zone", "share_of_bone"});
    for (const BoneInZone& bone : zone.bones)
        table.add_row({zone.share, zone.skin_share, static_cast<int>(zone.pieces.size()), static_cast<int>(zone.pieces.front().size()),
                       bone.name, bone.share_of_zone, bone.share_of_bone});
    table.write(analysis::path_in(folder, "zone.csv"));
}

Jolt jolt_at(const JoltCase& of, const JiggleSetting& setting)
{
    Jolt jolt = of.jolt;
    jolt.time_step_s = setting.time_step_s;
    return jolt;
}

struct JoltRecords {
    CsvTable responses = response_table(), series = CsvTable({"of", "time_s", "excursion_m", "speed_rms_m_s"});
    std::vector<analysis::Measurement> figures = {};
};

void add_reference(const JoltCase& of, const pbs::Character& character, const std::vector<int>& probe, const MeasuredJiggle& measured,
                   JoltRecords& records)
{
    const auto& own = measured.response;
    if (!own.swing.found()) return;
    const double hz = own.swing.frequency_hz.estimate;
    const auto reference = match_reference(character, dynamic_reference(first_young_pa), probe, jolt_at(of, measured.setting), hz);
    if (!reference) return;
    const auto& swing = reference->response.swing;
    add_response(records.responses, measured.setting, reference->young_pa, reference->time_step_s, reference->response);
    add_series(records.series, "snh_p1 beside " + text_of(measured.setting), reference->time_step_s, reference->response);
    analysis::CaseKey at = key_of(character.name, measured.setting);
    at.reference = "snh_p1";
    at.young_pa = reference->young_pa;
    const double pace = hz / swing.frequency_hz.estimate, reach = own.overshoot_over_jolt / reference->response.overshoot_over_jolt;
    records.figures.push_back({"C09", "frequency_over_reference", at, pace, own.swing.frequency_hz.low / swing.frequency_hz.high,
                               own.swing.frequency_hz.high / swing.frequency_hz.low, "1"});
    records.figures.push_back({"C09", "amplitude_over_reference", at, reach, reach, reach, "1"});
    records.figures.push_back(
        {"C09", "damping_ratio_of_reference", at, swing.damping_ratio.estimate, swing.damping_ratio.low, swing.damping_ratio.high, "1"});
}

}  // namespace

nlohmann::json settings_of(const JoltCase& of)
{
    auto settings = nlohmann::json::array();
    for (const JiggleSetting& setting : of.settings) settings.push_back(text_of(setting));
    const Jolt& jolt = of.jolt;
    nlohmann::json all = {{"scene", resolved_with_deformers(of.scene)},
                          {"jolt",
                           {{"direction", {jolt.direction.x(), jolt.direction.y(), jolt.direction.z()}},
                            {"length_m", jolt.length_m},
                            {"still_steps", jolt.still_steps},
                            {"steps", jolt.steps}}},
                          {"settings", settings}};
    if (of.with_reference)
        all["reference"] = {{"deformer", "stable neo-Hookean, linear elements, generalised alpha"},
                            {"first_young_pa", first_young_pa},
                            {"steps_a_period", reference_steps_a_period},
                            {"periods", reference_periods}};
    return all;
}

nlohmann::json settings_of(const WalkCase& of)
{
    auto settings = nlohmann::json::array();
    for (const double k : of.k_stretch) settings.push_back(text_of({.k_stretch = k}));
    return {{"scene", resolved_with_deformers(of.scene)}, {"settings", settings}, {"still_steps", of.still_steps}};
}

std::string record_jolts(const JoltCase& of, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(of.scene.character);
    const ZoneContents zone = zone_contents(character);
    JoltRecords records;
    std::vector<MeasuredJiggle> measured;
    std::string breakdown;
    for (const JiggleSetting& setting : of.settings) {
        const DeformerSpec spec = jiggling(spec_of(of.scene, "pbs"), setting);
        measured.push_back({setting, jolt_response(character, spec, zone.pieces.front(), jolt_at(of, setting))});
        const JoltResponse& response = measured.back().response;
        if (!response.finished) breakdown += text_of(setting) + ". ";
        add_response(records.responses, setting, analysis::not_known, setting.time_step_s, response);
        add_series(records.series, text_of(setting), setting.time_step_s, response);
    }
    if (of.with_reference)
        for (const MeasuredJiggle& one : measured) add_reference(of, character, zone.pieces.front(), one, records);
    else
        records.figures = jiggle_figures(character.name, measured);
    write_zone(folder, zone);
    records.responses.write(analysis::path_in(folder, "responses.csv"));
    records.series.write(analysis::path_in(folder, "series.csv"));
    analysis::measurement_table(records.figures).write(analysis::path_in(folder, "measurements.csv"));
    return breakdown;
}

std::string record_walk(const WalkCase& of, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(of.scene.character);
    const pbs::Motion motion = make_motion(of.scene.motion, character.skeleton, of.scene.file);
    CsvTable walk({"k_stretch", "moving_lag_rms_mm", "most_lag_rms_mm", "last_speed_share", "finished"});
    CsvTable series({"of", "time_s", "lag_rms_m", "speed_rms_m_s"});
    std::string breakdown;
    for (const double k : of.k_stretch) {
        const DeformerSpec spec = jiggling(spec_of(of.scene, "pbs"), {.k_stretch = k});
        const WalkResponse response = walk_response(character, motion, spec, pbs::jiggle_zone(character.binding), of.still_steps);
        if (!response.finished) breakdown += fmt::format("k_stretch {}. ", k);
        walk.add_row({k, response.moving_lag_mm, response.most_lag_mm, response.last_speed_share, static_cast<int>(response.finished)});
        for (std::size_t i = 0; i < response.lag_rms_m.size(); ++i)
            series.add_row({fmt::format("k_stretch {}", k), static_cast<double>(i + 1) * motion.time_step_s, response.lag_rms_m[i],
                            response.speed_rms_m_s[i]});
    }
    walk.write(analysis::path_in(folder, "walk.csv"));
    series.write(analysis::path_in(folder, "series.csv"));
    return breakdown;
}

}  // namespace experiments
