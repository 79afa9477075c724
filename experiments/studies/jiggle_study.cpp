// Jiggle (C09): does flesh in the paper's jiggling zone swing and come to rest by itself, at a pace that k_stretch alone sets?
//
//   BODY_jolt        the skeleton is moved by 2 cm in one step and held: frequency, damping and amplitude of the zone's largest piece
//                    against k_stretch, time step, iterations and masses; what the zone is on this body
//   limb_reference   a small limb's jolt beside finite elements in time (generalised alpha) that swing as fast
//   BODY_walk        two and a half seconds of CMU's clip 01_03, then held still for one: how far the flesh lags, and whether it rests
//
// The limb is moved along its bones, which is the one way in which the bind constraints leave all of its skin free; bodies are moved up.
// Writes DIR/jiggle/RUN/{responses,series,zone,measurements}.csv or walk.csv, and jiggle.md.
#include "analysis/atomic_file.hpp"
#include "analysis/csv_table.hpp"
#include "analysis/statistics.hpp"
#include "experiments/cases/motion_case.hpp"
#include "experiments/cases/real_bodies.hpp"
#include "experiments/deformers/option_names.hpp"
#include "experiments/error_split/posed_character.hpp"
#include "experiments/jiggle/jiggle_reference.hpp"
#include "experiments/jiggle/jiggle_settings.hpp"
#include "experiments/jiggle/jiggle_zone_contents.hpp"
#include "experiments/jiggle/walk_response.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;
using analysis::CsvTable;

constexpr double first_young_pa = 1e5;
constexpr int still_steps = 100;

std::string path_in(const std::string& folder, const char* name)
{
    return (fs::path(folder) / name).string();
}

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
    table.write(path_in(folder, "zone.csv"));
}

struct JoltCase {
    Scene scene;
    pbs::Vec3 direction;
    bool with_reference = false;
    std::vector<JiggleSetting> settings;
};

Jolt jolt_of(const JoltCase& of, const JiggleSetting& setting)
{
    return {.direction = of.direction, .time_step_s = setting.time_step_s};
}

// The reference beside each setting that swings.
void add_reference(const JoltCase& of, const pbs::Character& character, const std::vector<int>& probe, const MeasuredJiggle& measured,
                   CsvTable& responses, CsvTable& series, std::vector<analysis::Measurement>& figures)
{
    const auto& own = measured.response;
    if (!own.swing.found()) return;
    const double hz = own.swing.frequency_hz.estimate;
    const auto reference = match_reference(character, dynamic_reference(first_young_pa), probe, jolt_of(of, measured.setting), hz);
    if (!reference) return;
    const auto& swing = reference->response.swing;
    const double time_step_s = 1.0 / (24.0 * hz);
    add_response(responses, measured.setting, reference->young_pa, time_step_s, reference->response);
    add_series(series, "snh_p1 beside " + text_of(measured.setting), time_step_s, reference->response);
    const std::string at = fmt::format("{}, {}, {:.3g} Pa", character.name, text_of(measured.setting), reference->young_pa);
    const double pace = hz / swing.frequency_hz.estimate, reach = own.overshoot_over_jolt / reference->response.overshoot_over_jolt;
    figures.push_back({"C09", "frequency over the reference's", at, pace, own.swing.frequency_hz.low / swing.frequency_hz.high,
                       own.swing.frequency_hz.high / swing.frequency_hz.low, "1"});
    figures.push_back({"C09", "amplitude over the reference's", at, reach, reach, reach, "1"});
    figures.push_back({"C09", "damping ratio of the reference", at, swing.damping_ratio.estimate, swing.damping_ratio.low,
                       swing.damping_ratio.high, "1"});
}

std::string jolt_and_record(const JoltCase& of, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(of.scene.character);
    const ZoneContents zone = zone_contents(character);
    const DeformerSpec pbs = spec_of(of.scene, "pbs");
    CsvTable responses = response_table(), series({"of", "time_s", "excursion_m", "speed_rms_m_s"});
    std::vector<MeasuredJiggle> measured;
    std::string breakdown;
    for (const JiggleSetting& setting : of.settings) {
        measured.push_back({setting, jolt_response(character, jiggling(pbs, setting), zone.pieces.front(), jolt_of(of, setting))});
        const JoltResponse& response = measured.back().response;
        if (!response.finished) breakdown += text_of(setting) + ". ";
        add_response(responses, setting, analysis::not_known, setting.time_step_s, response);
        add_series(series, text_of(setting), setting.time_step_s, response);
    }
    std::vector<analysis::Measurement> figures = jiggle_figures(character.name, measured);
    if (of.with_reference) {
        figures.clear();  // of a coarser limb than the one that is judged
        for (const MeasuredJiggle& one : measured) add_reference(of, character, zone.pieces.front(), one, responses, series, figures);
    }
    write_zone(folder, zone);
    responses.write(path_in(folder, "responses.csv"));
    series.write(path_in(folder, "series.csv"));
    analysis::measurement_table(figures).write(path_in(folder, "measurements.csv"));
    return breakdown;
}

std::string walk_and_record(const Scene& scene, const std::vector<double>& k_stretch, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(scene.character);
    const pbs::Motion motion = make_motion(scene.motion, character.skeleton, scene.file);
    CsvTable walk({"k_stretch", "moving_lag_rms_mm", "most_lag_rms_mm", "last_speed_share", "finished"});
    CsvTable series({"of", "time_s", "lag_rms_m", "speed_rms_m_s"});
    std::string breakdown;
    for (const double k : k_stretch) {
        DeformerSpec spec = jiggling(spec_of(scene, "pbs"), {.k_stretch = k});
        spec.pbs.gravity_m_s2 = spec_of(scene, "pbs").pbs.gravity_m_s2;
        const WalkResponse response = walk_response(character, motion, spec, pbs::jiggle_zone(character.binding), still_steps);
        if (!response.finished) breakdown += fmt::format("k_stretch {}. ", k);
        walk.add_row({k, response.moving_lag_mm, response.most_lag_mm, response.last_speed_share, static_cast<int>(response.finished)});
        for (std::size_t i = 0; i < response.lag_rms_m.size(); ++i)
            series.add_row({fmt::format("k_stretch {}", k), static_cast<double>(i + 1) * motion.time_step_s, response.lag_rms_m[i],
                            response.speed_rms_m_s[i]});
    }
    walk.write(path_in(folder, "walk.csv"));
    series.write(path_in(folder, "series.csv"));
    return breakdown;
}

StudyRun jolt_run(const std::string& name, const JoltCase& of, double cost_s)
{
    auto settings = nlohmann::json::array();
    for (const JiggleSetting& setting : of.settings) settings.push_back(text_of(setting));
    return {.name = name,
            .cost_s = cost_s,
            .work = [of](const std::string& folder) { return jolt_and_record(of, folder); },
            .settings = {{"scene", resolved_with_deformers(of.scene)}, {"settings", settings}, {"reference", of.with_reference}}};
}

StudyRun walk_run(const std::string& name, const Scene& scene, const std::vector<double>& k_stretch, double cost_s)
{
    return {.name = name,
            .cost_s = cost_s,
            .work = [=](const std::string& folder) { return walk_and_record(scene, k_stretch, folder); },
            .settings = {{"scene", resolved_with_deformers(scene)}, {"k_stretch", k_stretch}, {"still_steps", still_steps}}};
}

void plan_body(const std::string& body, bool full, StudyPlan& plan)
{
    const std::vector<std::string> overrides = {"character.body=" + body, "motion.clip=01_03.bvh", "motion.duration_s=2.5",
                                                "deformers.use=[\"lbs\",\"pbs\"]", "reference.name=\"\""};
    const Scene scene = read_scene("human_01_01", overrides);
    plan.runs.push_back(jolt_run(body + "_jolt", {scene, pbs::Vec3::UnitY(), false, jiggle_settings()}, 3.0));
    const std::vector<double> k = full ? std::vector<double>{0.05, 0.1, 0.2, 0.5, 0.7, 0.9} : std::vector<double>{0.1, 0.7};
    plan.runs.push_back(walk_run(body + "_walk", scene, k, full ? 4.0 : 1.5));
}

// What the zone is, and a line a setting.
std::string jolt_text(const std::string& run)
{
    const CsvTable zone = analysis::read_csv(path_in(run, "zone.csv")), responses = analysis::read_csv(path_in(run, "responses.csv"));
    std::string text =
        fmt::format("{}: the zone is {:.0f} % of the vertices, {:.0f} % of it skin, in {} pieces;", fs::path(run).filename().string(),
                    100.0 * zone.number(0, "share_of_vertices"), 100.0 * zone.number(0, "share_on_skin"), zone.integer(0, "pieces"));
    for (int row = 0; row < std::min(zone.rows(), 5); ++row)
        text += fmt::format(" {} {:.0f} %", zone.text_at(row, "bone"), 100.0 * zone.number(row, "share_of_zone"));
    text +=
        "\n\n| deformer | k_stretch | step [ms] | iterations | masses | k_bind | outcome | frequency [Hz] | damping ratio | overshoot / "
        "jolt | left / "
        "peak |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (int row = 0; row < responses.rows(); ++row)
        text +=
            fmt::format("| {} | {} | {:.3g} | {} | {} | {} | {} | {:.2f} | {:.3f} | {:.2f} | {:.3f} |\n",
                        responses.text_at(row, "deformer"), responses.number(row, "k_stretch"), responses.number(row, "time_step_ms"),
                        responses.integer(row, "iterations"), responses.text_at(row, "masses"), responses.number(row, "k_bind"),
                        responses.text_at(row, "outcome"), responses.number(row, "frequency_hz"), responses.number(row, "damping_ratio"),
                        responses.number(row, "overshoot_over_jolt"), responses.number(row, "left_over_peak"));
    return text + "\n";
}

std::string walk_text(const std::string& run)
{
    const CsvTable walk = analysis::read_csv(path_in(run, "walk.csv"));
    std::string text = fs::path(run).filename().string() +
                       "\n\n| k_stretch | lag, rms [mm] | most [mm] | speed left after 1 s, share |\n|---|---|---|---|\n";
    for (int row = 0; row < walk.rows(); ++row)
        text += fmt::format("| {} | {:.2f} | {:.2f} | {:.4f} |\n", walk.number(row, "k_stretch"), walk.number(row, "moving_lag_rms_mm"),
                            walk.number(row, "most_lag_rms_mm"), walk.number(row, "last_speed_share"));
    return text + "\n";
}

}  // namespace

StudyPlan plan_jiggle_study(bool full)
{
    StudyPlan plan;
    const auto limb = [](const std::vector<std::string>& overrides) { return read_scene("limb_twist", overrides); };
    plan.runs.push_back(jolt_run("limb_jolt", {limb({}), pbs::Vec3::UnitX(), false, jiggle_settings()}, 2.5));
    const std::vector<JiggleSetting> beside =
        full ? std::vector<JiggleSetting>{{.k_stretch = 0.05}, {}, {.k_stretch = 0.2}, {.iterations = 6}} : std::vector<JiggleSetting>{{}};
    plan.runs.push_back(
        jolt_run("limb_reference", {limb({"character.vertices=400"}), pbs::Vec3::UnitX(), true, beside}, full ? 10.0 : 4.0));
    for (const std::string& body : installed_bodies(plan.left_out)) {
        try {
            plan_body(body, full, plan);
        } catch (const pbs::InputError& error) {
            plan.left_out.push_back({body, error.what()});
        }
    }
    return plan;
}

StudyConclusion conclude_jiggle_study(const std::string& folder, const StudyPlan&, const std::vector<std::string>& finished)
{
    std::string text;
    for (const std::string& run : finished) text += fs::exists(fs::path(run) / "walk.csv") ? walk_text(run) : jolt_text(run);
    analysis::write_text_atomically(path_in(folder, "jiggle.md"), text);
    return {text, !finished.empty()};
}

}  // namespace experiments
