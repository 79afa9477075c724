// The readings of the paper (ambiguity/reading.hpp): how much each changes the figures that claims are judged by, and whether it turns a
// verdict round. A reading is as the scene has it but for one place; every figure is measured by its claim's own study's functions.
//
//   limb_twist, limb_bend       C01, C02: the scenes' sweeps, each step by itself
//   human                       C01, C02: the clip 01_01, five frames a second, each step by itself
//   human_moving                C01, C02: what remembers the last step, every step of six seconds of the clip (--full: of all of it)
//   BODY_joint_twist, _bend     C04, C05: sections of the limb's joint, of the human's elbow
//   BODY_starts                 C03, C12: iterations from four starts, of the limb bent by 90 degrees, of the human's crouch
//   BODY_step                   C07, C09, C10: momentum of projections there, a jolt, the time of a frame by turns
//
// Writes DIR/ambiguity/RUN/ambiguity.csv, of the first four also figures.csv (volume, jiggling, distance), and of all of them
// ambiguity.csv, ambiguity.txt (the table that is printed), figures.csv and figures.md.
#include "analysis/atomic_file.hpp"
#include "experiments/ambiguity/ambiguity_table.hpp"
#include "experiments/ambiguity/claim_changes_text.hpp"
#include "experiments/ambiguity/reading_comparison.hpp"
#include "experiments/ambiguity/reading_figures.hpp"
#include "experiments/ambiguity/untouched.hpp"
#include "experiments/artefacts/artefact_figures.hpp"
#include "experiments/deformers/option_names.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>

namespace experiments {
namespace {

namespace fs = std::filesystem;

std::string path_in(const std::string& folder, const char* name)
{
    return (fs::path(folder) / name).string();
}

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
    table.table().write(path_in(folder, "figures.csv"));
    changes.table().write(path_in(folder, "ambiguity.csv"));
    return breakdown;
}

nlohmann::json settings_of(const Scene& scene, const std::vector<Reading>& readings)
{
    nlohmann::json settings;
    for (const Reading& reading : readings) settings.push_back(to_json(reading));
    return {{"scene", resolved_with_deformers(scene)}, {"readings", settings}};
}

std::vector<Reading> all_readings(const Scene& scene)
{
    const pbs::PbsOptions own = spec_of(scene, "pbs").pbs;
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
            .settings = settings_of(scene, readings)};
}

// A run of claims measured otherwise than by volume.
StudyRun claims_run(const std::string& name, const Scene& scene, const nlohmann::json& settings, double cost_s,
                    const std::function<void(ReadingComparison&)>& measure)
{
    const std::vector<Reading> readings = all_readings(scene);
    nlohmann::json all = settings_of(scene, readings);
    all.update(settings);
    const auto work = [=, body = scene.character.body](const std::string& folder) {
        ReadingComparison comparison(body, readings);
        measure(comparison);
        comparison.changes().write(path_in(folder, "ambiguity.csv"));
        return comparison.breakdown();
    };
    return {.name = name, .cost_s = cost_s, .work = work, .settings = all};
}

StudyRun sections_run(const std::string& name, const ArtefactCase& of, double cost_s)
{
    const std::string claim = of.claim == ArtefactCase::Claim::bulge ? "C05" : "C04";
    nlohmann::json poses;
    for (const ArtefactPose& pose : of.poses) poses.push_back({{"frame", pose.frame}, {"name", pose.name}});
    const nlohmann::json settings = {{"claim", claim}, {"poses", poses}, {"joint", of.joint}, {"deepest_bend_deg", deepest_bend_deg}};
    return claims_run(name, of.scene, settings, cost_s, [=](ReadingComparison& comparison) {
        comparison.measure({claim}, [&](const auto& readings) { return figures_of_sections(of, readings); });
    });
}

nlohmann::json settings_of(const ReadingsCase& of)
{
    const pbs::Vec3& jolt = of.jolt_direction;
    return {{"frame", of.frame},
            {"pose", of.pose},
            {"jolt_direction", {jolt.x(), jolt.y(), jolt.z()}},
            {"iterations", of.most_iterations},
            {"jolt_steps", of.jolt_steps},
            {"timing_s", of.timing_s}};
}

StudyRun starts_run(const std::string& body, const ReadingsCase& of, double cost_s)
{
    return claims_run(body + "_starts", of.scene, settings_of(of), cost_s, [=](ReadingComparison& comparison) {
        comparison.measure({"C03", "C12"}, [&](const auto& readings) { return figures_of_starts(of, readings); });
    });
}

StudyRun step_run(const std::string& body, const ReadingsCase& of, double cost_s)
{
    return claims_run(body + "_step", of.scene, settings_of(of), cost_s, [=](ReadingComparison& comparison) {
        comparison.measure({"C07"}, [&](const auto& readings) { return figures_of_projections(of, readings); });
        comparison.measure({"C09"}, [&](const auto& readings) { return figures_of_jolts(of, readings); });
        comparison.measure({"C10"}, [&](const auto& readings) { return figures_of_frames(of, readings); });
    });
}

// A joint turned by 5 degrees a frame, looked at every `look_deg`.
ArtefactCase turned(const std::string& what, std::vector<std::string> overrides, int look_deg, int looks)
{
    constexpr int frame_deg = 5;
    overrides.insert(overrides.end(), {R"(deformers.use=["lbs","pbs","snh_p1"])", "reference.name=snh_p1",
                                       fmt::format("motion.angle_deg={}", look_deg * looks),
                                       fmt::format("motion.frames={}", look_deg * looks / frame_deg + 1)});
    ArtefactCase of;
    of.scene = read_scene("limb_" + what, overrides);
    of.claim = what == "twist" ? ArtefactCase::Claim::candy_wrapper : ArtefactCase::Claim::bulge;
    for (int i = 1; i <= looks; ++i) of.poses.push_back({i * look_deg / frame_deg, fmt::format("{} {} deg", what, i * look_deg)});
    return of;
}

ArtefactCase turned_elbow(const std::string& what)
{
    const std::string name = "upper_arm.L|forearm_upper.L";
    const pbs::Character human = pbs::make_character({.body = "human"});
    for (const LimbJoint& joint : limb_joints(human)) {
        if (joint.name != name) continue;
        const pbs::Vec3 axis = what == "twist" ? twist_axis(human.skeleton, joint) : hinge_axis(human.skeleton, joint);
        ArtefactCase of = turned(what,
                                 {"character.body=human", "motion.joint=" + human.skeleton.bones[joint.child].name,
                                  fmt::format("motion.axis=[{:.9f},{:.9f},{:.9f}]", axis.x(), axis.y(), axis.z())},
                                 45, 2);
        of.joint = name;
        return of;
    }
    throw pbs::InputError("human", 0, "joint", name, "expected it among the body's joints");
}

void plan_limb(bool full, StudyPlan& plan)
{
    const Scene twist = read_scene("limb_twist", {}), bend = read_scene("limb_bend", {});
    plan.runs.push_back(volume_run("limb_twist", "limb", twist, all_readings(twist), 1.0));
    plan.runs.push_back(volume_run("limb_bend", "limb", bend, all_readings(bend), 0.9));
    plan.runs.push_back(sections_run("limb_joint_twist", turned("twist", {}, 30, 6), 1.4));
    plan.runs.push_back(sections_run("limb_joint_bend", turned("bend", {}, 30, 3), 3.5));
    const ReadingsCase of = {.scene = bend,
                             .frame = 18,
                             .pose = "bend 90",
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
    plan.runs.push_back(volume_run("human", "human", each, readings_of_a_step(spec_of(each, "pbs").pbs), 4.5));
    plan.runs.push_back(volume_run("human_moving", "human", every, readings_of_motion(spec_of(every, "pbs").pbs), full ? 31.0 : 10.0));
    plan.runs.push_back(sections_run("human_joint_twist", turned_elbow("twist"), 1.1));
    plan.runs.push_back(sections_run("human_joint_bend", turned_elbow("bend"), 2.0));
    const ReadingsCase of = {.scene = read_scene("human_01_01", {"output.frames=[]", "output.frame_names=[]"}),
                             .frame = 164,
                             .pose = "01_01 crouch",
                             .most_iterations = full ? 1000 : 400,
                             .jolt_steps = full ? 150 : 60,
                             .timing_s = full ? 6.0 : 1.0};
    plan.runs.push_back(starts_run("human", of, full ? 8.0 : 5.0));
    plan.runs.push_back(step_run("human", of, full ? 26.0 : 11.0));
}

analysis::CsvTable of_all(const std::vector<std::string>& runs, const char* name)
{
    analysis::CsvTable all{{}};
    for (const std::string& run : runs)
        if (fs::exists(fs::path(run) / name)) all.append(analysis::read_csv(path_in(run, name)));
    return all;
}

}  // namespace

StudyPlan plan_ambiguity_study(bool full)
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

StudyConclusion conclude_ambiguity_study(const std::string& folder, const StudyPlan&, const std::vector<std::string>& finished)
{
    const analysis::CsvTable changes = of_all(finished, "ambiguity.csv"), figures = of_all(finished, "figures.csv");
    changes.write(path_in(folder, "ambiguity.csv"));
    figures.write(path_in(folder, "figures.csv"));
    const std::string text = changes.rows() == 0 ? "" : claim_changes_text(changes);
    analysis::write_text_atomically(path_in(folder, "ambiguity.txt"), text);
    analysis::write_text_atomically(path_in(folder, "figures.md"), figures.rows() == 0 ? "" : ambiguity_markdown({figures}));
    return {text, !finished.empty()};
}

}  // namespace experiments
