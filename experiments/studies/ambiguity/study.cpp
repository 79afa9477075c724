// The readings of the paper (ambiguity/reading.hpp): how much each changes the figures that claims are judged by, and whether it turns a
// verdict round. A reading is as the scene has it but for one place; every figure is measured by its claim's own study's functions, but
// for C10, a frame's processor time, where the study takes wall time, and C09, without what the study makes of all its settings at once.
//
//   limb_twist, limb_bend       C01, C02: the scenes' sweeps, each step by itself
//   human                       C01, C02: the clip 01_01, five frames a second, each step by itself
//   human_moving                C01, C02: what remembers the last step, every step of six seconds of the clip (--full: of all of it)
//   BODY_joint_twist, _bend     C04, C05: sections of the limb's joint, of the human's elbow
//   BODY_starts                 C03: iterations from four starts, of the limb bent by 90 degrees, of the human's crouch; there C12, too
//   BODY_step                   C07, C09, C10: momentum of projections there, a jolt, the time of a frame by turns (the human's: --full)
//
// Writes DIR/ambiguity/RUN/ambiguity.csv, of the first four also figures.csv (volume, jiggling, distance), and of all of them
// ambiguity.csv, ambiguity.txt (the table that is printed), figures.csv and figures.md.
#include "analysis/records/atomic_file.hpp"
#include "experiments/studies/ambiguity/ambiguity_table.hpp"
#include "experiments/studies/ambiguity/claim_changes_text.hpp"
#include "experiments/studies/ambiguity/reading_comparison.hpp"
#include "experiments/studies/ambiguity/reading_figures.hpp"
#include "experiments/studies/ambiguity/untouched.hpp"
#include "experiments/studies/artefacts/artefact_figures.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "analysis/records/folder_files.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace experiments {
namespace {

namespace fs = std::filesystem;

struct Baseline {
    Reading reading;
    ReadMotion moved;
};

// C01, C02.
void compare_volume(ClaimChanges& changes, const std::string& body, const Reading& reading, const Baseline& a, const ReadMotion& b)
{
    for (const char* claim : {"C01", "C02"})
        if (const std::string reason = untouched_because(claim, reading, a.reading); !reason.empty())
            changes.add_untouched(body, claim, reading, reason);
        else
            changes.add(body, claim, reading, {judged(a.moved), !a.moved.finite}, {judged(b), !b.finite});
}

std::string read_and_record(const std::string& body, const Scene& scene, const std::vector<Reading>& readings, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(scene.character);
    const std::vector<bool> zone = pbs::jiggle_zone(character.binding);
    std::map<std::string, Baseline> baselines;
    AmbiguityTable table;
    ClaimChanges changes;
    std::string breakdown;
    for (const Reading& reading : readings) {
        if (reading.options.jiggle && scene.motion.clip.empty()) {
            if (reading.place.empty()) continue;
            for (const char* claim : {"C01", "C02"}) changes.add_untouched(body, claim, reading, "a sweep has no speed of its own");
            continue;
        }
        ReadMotion moved = move(character, scene, reading);
        if (!moved.finite) breakdown += reading.name + " is not finite. ";
        if (reading.place.empty()) {
            baselines.emplace(reading.name, Baseline{reading, std::move(moved)});
            continue;
        }
        const Baseline& baseline = baselines.at(reading.baseline);
        table.add(scene, reading, baseline.moved, moved, baselines.at(own_reading).moved, zone);
        compare_volume(changes, body, reading, baseline, moved);
    }
    table.table().write(analysis::path_in(folder, "figures.csv"));
    changes.table().write(analysis::path_in(folder, "ambiguity.csv"));
    return breakdown;
}

nlohmann::json settings_of(const Scene& scene, const std::vector<Reading>& readings, const std::vector<std::string>& claims)
{
    nlohmann::json settings;
    for (const Reading& reading : readings) settings.push_back(to_json(reading));
    std::vector<analysis::Claim> judging;
    for (const std::string& claim : claims) judging.push_back(claim_named(claim));
    return {{"scene", resolved_with_deformers(scene)}, {"readings", settings}, {"claims", claims}, {"bounds", digest_of(judging)}};
}

std::vector<Reading> all_readings(const Scene& scene)
{
    const pbs::PbsOptions own = options_of<pbs::PbsOptions>(spec_of(scene, "pbs"));
    std::vector<Reading> readings = readings_of_a_step(own);
    for (const Reading& reading : readings_of_motion(own))
        if (reading.name != own_reading) readings.push_back(reading);
    return readings;
}

StudyRun volume_run(const std::string& name, const std::string& body, Scene scene, const std::vector<Reading>& readings, double cost_s)
{
    scene.name = name;
    return {.name = name,
            .cost_s = cost_s,
            .work = [=](const std::string& folder) { return read_and_record(body, scene, readings, folder); },
            .settings = settings_of(scene, readings, {"C01", "C02"})};
}

// A run of claims measured otherwise than by volume.
StudyRun claims_run(const std::string& name, const Scene& scene, const std::vector<std::string>& claims, const nlohmann::json& settings,
                    double cost_s, const std::function<void(ReadingComparison&)>& measure)
{
    const std::vector<Reading> readings = all_readings(scene);
    nlohmann::json all = settings_of(scene, readings, claims);
    all.update(settings);
    const auto work = [=, body = scene.character.body](const std::string& folder) {
        ReadingComparison comparison(body, readings);
        measure(comparison);
        comparison.changes().write(analysis::path_in(folder, "ambiguity.csv"));
        return comparison.breakdown();
    };
    return {.name = name, .cost_s = cost_s, .work = work, .settings = all};
}

StudyRun sections_run(const std::string& name, const ArtefactCase& of, double cost_s)
{
    const std::string claim = of.claim == ArtefactCase::Claim::bulge ? "C05" : "C04";
    return claims_run(name, of.scene, {claim}, to_json(of), cost_s, [=](ReadingComparison& comparison) {
        comparison.measure({claim}, [&](const auto& readings) { return figures_of_sections(of, readings); });
    });
}

StudyRun starts_run(const std::string& body, const ReadingsCase& of, double cost_s)
{
    const std::vector<std::string> claims = {"C03", "C12"};
    return claims_run(body + "_starts", of.scene, claims, to_json(of), cost_s, [=](ReadingComparison& comparison) {
        comparison.measure(claims, [&](const auto& readings) { return figures_of_starts(of, readings); });
    });
}

StudyRun step_run(const std::string& body, const ReadingsCase& of, double cost_s)
{
    return claims_run(body + "_step", of.scene, {"C07", "C09", "C10"}, to_json(of), cost_s, [=](ReadingComparison& comparison) {
        comparison.measure({"C07"}, [&](const auto& readings) { return figures_of_projections(of, readings); });
        comparison.measure({"C09"}, [&](const auto& readings) { return figures_of_jolts(of, readings); });
        comparison.measure({"C10"}, [&](const auto& readings) { return figures_of_frames(of, readings); });
    });
}

LimbJoint joint_of(const pbs::Character& character, const std::string& name)
{
    const std::vector<LimbJoint> joints = limb_joints(character);
    const auto found = std::find_if(joints.begin(), joints.end(), [&](const LimbJoint& joint) { return joint.name == name; });
    if (found == joints.end()) throw pbs::InputError(character.name, 0, "joint", name, "expected it among the body's joints");
    return *found;
}

// A joint turned by 5 degrees a frame, looked at every `look_deg`.
ArtefactCase turned(const std::string& body, const std::string& joint, const std::string& what, int look_deg, int looks)
{
    constexpr int frame_deg = 5;
    const pbs::Character character = pbs::make_character({.body = body});
    const LimbJoint at = joint_of(character, joint);
    const pbs::Vec3 axis = what == "twist" ? twist_axis(character.skeleton, at) : hinge_axis(character.skeleton, at);
    ArtefactCase of;
    of.scene = read_scene("limb_" + what, {"character.body=" + body, "motion.joint=" + character.skeleton.bones[at.child].name,
                                           fmt::format("motion.axis=[{:.9f},{:.9f},{:.9f}]", axis.x(), axis.y(), axis.z()),
                                           fmt::format("motion.angle_deg={}", look_deg * looks),
                                           fmt::format("motion.frames={}", look_deg * looks / frame_deg + 1),
                                           R"(deformers.use=["lbs","pbs","snh_p1"])", "reference.name=snh_p1"});
    of.joint = joint;
    of.claim = what == "twist" ? ArtefactCase::Claim::candy_wrapper : ArtefactCase::Claim::bulge;
    for (int i = 1; i <= looks; ++i)
        of.poses.push_back(
            {i * look_deg / frame_deg, fmt::format("{} {} deg", what, i * look_deg), {.motion = what, .angle_deg = double(i * look_deg)}});
    return of;
}

void plan_limb(bool full, StudyPlan& plan)
{
    const Scene twist = read_scene("limb_twist", {}), bend = read_scene("limb_bend", {});
    plan.runs.push_back(volume_run("limb_twist", "limb", twist, all_readings(twist), 1.0));
    plan.runs.push_back(volume_run("limb_bend", "limb", bend, all_readings(bend), 0.9));
    const std::string joint = "upper|forearm";
    plan.runs.push_back(sections_run("limb_joint_twist", turned("limb", joint, "twist", 30, 6), 1.4));
    plan.runs.push_back(sections_run("limb_joint_bend", turned("limb", joint, "bend", 30, 3), 3.5));
    const ReadingsCase of = {.scene = bend,
                             .frame = 18,
                             .pose = "bend 90",
                             .key = {.motion = "bend", .angle_deg = 90.0},
                             .jolt_direction = pbs::Vec3::UnitX(),
                             .most_iterations = full ? 1000 : 400,
                             .jolt_steps = full ? 150 : 60,
                             .timing_s = full ? 6.0 : 1.0};
    plan.runs.push_back(starts_run("limb", of, full ? 5.0 : 2.7));
    plan.runs.push_back(step_run("limb", of, full ? 24.0 : 10.0));
}

void plan_human(bool full, StudyPlan& plan)
{
    const std::vector<std::string> five_a_second = {"motion.rate_hz=5.0", "output.frames=[]", "output.frame_names=[]"};
    std::vector<std::string> moving = five_a_second;
    if (!full) moving.insert(moving.end(), {"motion.start_s=1.0", "motion.duration_s=6.0"});
    const Scene each = read_scene("human_01_01", five_a_second), every = read_scene("human_01_01", moving);
    plan.runs.push_back(volume_run("human", "human", each, readings_of_a_step(options_of<pbs::PbsOptions>(spec_of(each, "pbs"))), 4.5));
    plan.runs.push_back(volume_run("human_moving", "human", every, readings_of_motion(options_of<pbs::PbsOptions>(spec_of(every, "pbs"))),
                                   full ? 31.0 : 10.0));
    const std::string elbow = "upper_arm.L|forearm_upper.L";
    plan.runs.push_back(sections_run("human_joint_twist", turned("human", elbow, "twist", 45, 2), 1.1));
    plan.runs.push_back(sections_run("human_joint_bend", turned("human", elbow, "bend", 45, 2), 2.0));
    const ReadingsCase of = {.scene = read_scene("human_01_01", {"output.frames=[]", "output.frame_names=[]"}),
                             .frame = 164,
                             .pose = "01_01 crouch",
                             .key = {.motion = "01_01", .pose = "crouch"},
                             .most_iterations = full ? 1000 : 400,
                             .jolt_steps = full ? 150 : 60,
                             .timing_s = full ? 6.0 : 1.0};
    plan.runs.push_back(starts_run("human", of, full ? 8.0 : 5.0));
    if (full) plan.runs.push_back(step_run("human", of, 26.0));
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan_limb(full, plan);
    try {
        plan_human(full, plan);
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    const analysis::CsvTable changes = finished.gathered("ambiguity.csv"), figures = finished.gathered("figures.csv");
    finished.write("ambiguity.csv", changes);
    finished.write("figures.csv", figures);
    const std::string text = changes.rows() == 0 ? "" : claim_changes_text(changes);
    finished.write("ambiguity.txt", text);
    finished.write("figures.md", figures.rows() == 0 ? "" : ambiguity_markdown({figures}));
    return {text, !finished.none()};
}

}  // namespace

Study ambiguity_study()
{
    return {"ambiguity", plan, quick_and_full, conclude};
}

}  // namespace experiments
