// Jiggle (C09): does flesh in the paper's jiggling zone swing and come to rest by itself, at a rate that k_stretch alone sets?
//
//   BODY_jolt        the skeleton is moved by 2 cm in one step and held: frequency, damping and amplitude of the zone's largest piece
//                    against k_stretch, time step, iterations and masses; what the zone is on this body
//   limb_reference   the jolt of a small limb, compared with finite elements in time (generalised alpha) that swing as fast
//   BODY_walk        two and a half seconds of CMU's clip 01_03, then held still for one: how far the flesh lags, and whether it rests
//
// The limb is moved along its bones, the only direction in which the bind constraints leave all of its skin free; bodies are moved up.
// Flesh has no gravity in a jolt, so that it lies still before it, and has gravity in a walk.
// Writes DIR/jiggle/RUN/{responses,series,zone,measurements}.csv or walk.csv, and jiggle.md.
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace experiments {
namespace {

JoltCase jolt_case(const StudyCase& of)
{
    JoltCase jolt{of.scene(), {}, jiggle_settings(), of.value("with_reference", false)};
    const auto along = of.value<std::vector<double>>("along", {0.0, 1.0, 0.0});
    jolt.jolt.direction = pbs::Vec3(along.at(0), along.at(1), along.at(2));
    if (!of.has("settings")) return jolt;
    jolt.settings.clear();
    for (const nlohmann::json& differs : of.value<nlohmann::json>("settings"))
        jolt.settings.push_back({.k_stretch = differs.value("k_stretch", JiggleSetting{}.k_stretch),
                                 .iterations = differs.value("iterations", JiggleSetting{}.iterations)});
    return jolt;
}

StudyPlan plan(bool full)
{
    return plan_of_cases("jiggle", full, [](const StudyCase& of, StudyPlan& plan) {
        if (of.value<std::string>("measure") == "jolt")
            plan.runs.push_back(work_run(of.name, jolt_case(of), of.cost_s, record_jolts));
        else
            plan.runs.push_back(
                work_run<WalkCase>(of.name, {of.scene(), of.value<std::vector<double>>("k_stretch")}, of.cost_s, record_walk));
    });
}

// Records the zone on the body, and the response at each setting.
std::string jolt_text(const std::string& folder)
{
    const auto zone = rows_of(zone_columns, analysis::read_csv(analysis::path_in(folder, "zone.csv")));
    const ZoneRow& all = zone.at(0);
    std::string text = fmt::format("the zone is {:.0f} % of the vertices, {:.0f} % of it skin, in {} pieces;",
                                   100.0 * all.share_of_vertices, 100.0 * all.share_on_skin, all.pieces);
    for (std::size_t i = 0; i < std::min(zone.size(), std::size_t{5}); ++i)
        text += fmt::format(" {} {:.0f} %", zone[i].bone.name, 100.0 * zone[i].bone.share_of_zone);
    return text + "\n\n" +
           markdown_table(analysis::read_csv(analysis::path_in(folder, "responses.csv")),
                          {{"deformer", "deformer"},
                           {"k_stretch", "k_stretch"},
                           {"step [ms]", "time_step_ms", "{:.3g}"},
                           {"iterations", "iterations"},
                           {"masses", "masses"},
                           {"k_bind", "k_bind"},
                           {"outcome", "outcome"},
                           {"frequency [Hz]", "frequency_hz", "{:.2f}"},
                           {"damping ratio", "damping_ratio", "{:.3f}"},
                           {"overshoot / jolt", "overshoot_over_jolt", "{:.2f}"},
                           {"left / peak", "left_over_peak", "{:.3f}"}});
}

std::string walk_text(const std::string& walk)
{
    return "walk\n\n" + markdown_table(analysis::read_csv(walk), {{"k_stretch", "k_stretch"},
                                                                  {"lag, rms [mm]", "moving_lag_rms_mm", "{:.2f}"},
                                                                  {"most [mm]", "most_lag_rms_mm", "{:.2f}"},
                                                                  {"share of speed left after 1 s", "last_speed_share", "{:.4f}"}});
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::string text;
    for (const std::string& run : finished.folders) {
        const std::string walk = analysis::path_in(run, "walk.csv");
        text += std::filesystem::path(run).filename().string() + ": " + (std::filesystem::exists(walk) ? walk_text(walk) : jolt_text(run)) +
                "\n";
    }
    finished.write("jiggle.md", text);
    return {text, !finished.none()};
}

}  // namespace

Study jiggle_study()
{
    return {"jiggle", plan, quick_and_full, conclude};
}

}  // namespace experiments
