// The readings of the paper (ambiguity/reading.hpp): how much each changes the values that claims are judged by, and whether it turns a
// verdict round. A reading differs from the scene in one place. Every value is measured by the functions of its claim's own study, with two
// exceptions: C10 takes a frame's processor time, where its study takes wall time, and C09 lacks what its study computes from all settings.
//
//   limb_twist, limb_bend       C01, C02: the scenes' sweeps, each step by itself
//   human                       C01, C02: the clip 01_01, five frames per second, each step by itself
//   human_moving                C01, C02: what remembers the last step, every step of six seconds of the clip (--full: of all of it)
//   BODY_joint_twist, _bend     C04, C05: sections of the limb's joint, of the human's elbow
//   BODY_starts                 C03, C12: iterations from four initial guesses, on the limb bent by 90 degrees and in the human's crouch
//   BODY_step                   C07, C09, C10: momentum of projections there, a jolt, and the time per frame in turns (the human's: --full)
//
// Writes DIR/ambiguity/RUN/ambiguity.csv and, for the first four, figures.csv (volume, jiggling, distance); and ambiguity.csv,
// ambiguity.txt (the table that is printed), figures.csv and figures.md for all of them.
#include "analysis/records/record_files.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/ambiguity/ambiguity_report.hpp"
#include "experiments/studies/ambiguity/reading_values.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "experiments/studies/shared/clip_frames.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

std::vector<Reading> all_readings(const Scene& scene)
{
    const pbs::PbsOptions own = options_of<pbs::PbsOptions>(spec_of(scene, "pbs"));
    std::vector<Reading> readings = readings_of_a_step(own);
    for (const Reading& reading : readings_of_motion(own))
        if (reading.name != own_reading) readings.push_back(reading);
    return readings;
}

// The further settings of a run: it repeats when a reading or a bound of its claims changes.
nlohmann::json judging(const std::vector<Reading>& readings, const std::vector<std::string>& claims)
{
    std::vector<analysis::Claim> judging;
    for (const std::string& claim : claims) judging.push_back(claim_named(claim));
    return {{"readings", option_json(readings)}, {"claims", claims}, {"bounds", digest_of(judging)}};
}

StudyRun volume_run(const std::string& name, const std::string& body, Scene scene, const std::vector<Reading>& readings, double cost_s)
{
    scene.name = name;
    StudyRun run = work_run<VolumeReadings>(name, {body, scene, readings}, cost_s, record_volume);
    run.settings.update(judging(readings, {"C01", "C02"}));
    return run;
}

// Claims that are measured together, and the function that measures them.
template <typename Case>
struct MeasuredClaims {
    std::vector<std::string> claims;
    std::vector<ReadingValues> (*values)(const Case& of, const std::vector<Reading>& readings);
};

// A run of claims that are not measured by volume.
template <typename Case>
StudyRun claims_run(const std::string& name, const Case& of, double cost_s, const std::vector<MeasuredClaims<Case>>& parts)
{
    std::vector<std::string> claims;
    for (const auto& part : parts) claims.insert(claims.end(), part.claims.begin(), part.claims.end());
    StudyRun run{.name = name, .cost_s = cost_s};
    run.settings = to_json(of);
    run.settings.update(judging(all_readings(of.scene), claims));
    run.work = [of, parts](const std::string& folder) {
        ReadingComparison comparison(of.scene.character.body, all_readings(of.scene));
        for (const auto& [together, values] : parts)
            comparison.measure(together, [&](const std::vector<Reading>& readings) { return values(of, readings); });
        const std::vector<ClaimChange>& changes = comparison.changes();
        table_of(used_columns(claim_change_columns(), changes), changes).write(analysis::path_in(folder, "ambiguity.csv"));
        return comparison.breakdown();
    };
    return run;
}

const std::vector<MeasuredClaims<ArtefactCase>> twisted = {{{"C04"}, values_of_sections}}, bent = {{{"C05"}, values_of_sections}};
const std::vector<MeasuredClaims<ReadingsCase>> starts = {{{"C03", "C12"}, values_of_starts}}, step = {{{"C07"}, values_of_projections},
                                                                                                       {{"C09"}, values_of_jolts},
                                                                                                       {{"C10"}, values_of_frames}};

LimbJoint joint_of(const pbs::Character& character, const std::string& name)
{
    const std::vector<LimbJoint> joints = limb_joints(character);
    const auto found = std::ranges::find(joints, name, &LimbJoint::name);
    if (found == joints.end()) throw pbs::InputError(character.name, 0, "joint", name, "expected it among the body's joints");
    return *found;
}

// A joint that turns by 5 degrees per frame, with a pose every `look_deg`.
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
                                           R"(deformers.use=["lbs","pbs","nh_p1"])", "reference.name=nh_p1"});
    of.joint = joint;
    of.claim = what == "twist" ? ArtefactCase::Claim::candy_wrapper : ArtefactCase::Claim::bulge;
    for (int i = 1; i <= looks; ++i)
        of.poses.push_back(
            {i * look_deg / frame_deg, fmt::format("{} {} deg", what, i * look_deg), {.motion = what, .angle_deg = double(i * look_deg)}});
    return of;
}

void set_effort(ReadingsCase& of, bool full)
{
    of.most_iterations = full ? 1000 : 400;
    of.jolt_steps = full ? 150 : 60;
    of.timing_s = full ? 6.0 : 1.0;
}

void plan_limb(bool full, StudyPlan& plan)
{
    const Scene twist = read_scene("limb_twist", {}), bend = read_scene("limb_bend", {});
    plan.runs.push_back(volume_run("limb_twist", "limb", twist, all_readings(twist), 1.0));
    plan.runs.push_back(volume_run("limb_bend", "limb", bend, all_readings(bend), 0.9));
    const std::string joint = "upper|forearm";
    plan.runs.push_back(claims_run("limb_joint_twist", turned("limb", joint, "twist", 30, 6), 1.4, twisted));
    plan.runs.push_back(claims_run("limb_joint_bend", turned("limb", joint, "bend", 30, 3), 3.5, bent));
    ReadingsCase of = {
        .scene = bend, .frame = 18, .pose = "bend_90", .key = {.motion = "bend", .angle_deg = 90.0}, .jolt_direction = pbs::Vec3::UnitX()};
    set_effort(of, full);
    plan.runs.push_back(claims_run("limb_starts", of, full ? 5.0 : 2.7, starts));
    plan.runs.push_back(claims_run("limb_step", of, full ? 24.0 : 10.0, step));
}

void plan_human(bool full, StudyPlan& plan)
{
    const std::vector<std::string> five_per_second = {"motion.rate_hz=5.0", "output.frames=[]", "output.frame_names=[]"};
    std::vector<std::string> moving = five_per_second;
    if (!full) moving.insert(moving.end(), {"motion.start_s=1.0", "motion.duration_s=6.0"});
    const Scene each = read_scene("human_01_01", five_per_second), every = read_scene("human_01_01", moving);
    plan.runs.push_back(volume_run("human", "human", each, readings_of_a_step(options_of<pbs::PbsOptions>(spec_of(each, "pbs"))), 4.5));
    plan.runs.push_back(volume_run("human_moving", "human", every, readings_of_motion(options_of<pbs::PbsOptions>(spec_of(every, "pbs"))),
                                   full ? 31.0 : 10.0));
    const std::string elbow = "upper_arm.L|forearm_upper.L";
    plan.runs.push_back(claims_run("human_joint_twist", turned("human", elbow, "twist", 45, 2), 1.1, twisted));
    plan.runs.push_back(claims_run("human_joint_bend", turned("human", elbow, "bend", 45, 2), 2.0, bent));
    ReadingsCase of = {.scene = read_scene("human_01_01", {"output.frames=[]", "output.frame_names=[]"}),
                       .frame = clip_frames::crouch,
                       .pose = "01_01_crouch",
                       .key = {.motion = "01_01", .pose = "crouch"}};
    set_effort(of, full);
    plan.runs.push_back(claims_run("human_starts", of, full ? 8.0 : 5.0, starts));
    if (full) plan.runs.push_back(claims_run("human_step", of, 26.0, step));
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
    const auto changes = finished.rows(claim_change_columns(), "ambiguity.csv");
    const auto volumes = finished.rows(volume_change_columns, "figures.csv");
    finished.write("ambiguity.csv", used_columns(claim_change_columns(), changes), changes);
    finished.write("figures.csv", volume_change_columns, volumes);
    const std::string text = changes.empty() ? "" : claim_changes_text(changes);
    finished.write("ambiguity.txt", text);
    finished.write("figures.md", volumes.empty() ? "" : volume_markdown(volumes));
    return {text, !finished.none()};
}

}  // namespace

Study ambiguity_study()
{
    return {"ambiguity", plan, quick_and_full, conclude};
}

}  // namespace experiments
