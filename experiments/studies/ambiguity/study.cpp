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
#include "experiments/studies/ambiguity/claim_changes.hpp"
#include "experiments/studies/ambiguity/reading_values.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

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

LimbJoint joint_of(const pbs::Character& character, const std::string& name)
{
    const std::vector<LimbJoint> joints = limb_joints(character);
    const auto found = std::ranges::find(joints, name, &LimbJoint::name);
    if (found == joints.end()) throw pbs::InputError(character.name, 0, "joint", name, "expected it among the body's joints");
    return *found;
}

// A joint that turns by 5 degrees per frame, with a pose every `look_deg`.
ArtefactCase turned(const nlohmann::json& of)
{
    constexpr int frame_deg = 5;
    const std::string body = of.at("body"), what = of.at("what");
    const int look_deg = of.at("look_deg"), looks = of.at("looks");
    const pbs::Character character = pbs::make_character({.body = body});
    const LimbJoint at = joint_of(character, of.at("joint"));
    const pbs::Vec3 axis = what == "twist" ? twist_axis(character.skeleton, at) : hinge_axis(character.skeleton, at);
    ArtefactCase turned;
    turned.scene = read_scene("limb_" + what, {"character.body=" + body, "motion.joint=" + character.skeleton.bones[at.child].name,
                                               fmt::format("motion.axis=[{:.9f},{:.9f},{:.9f}]", axis.x(), axis.y(), axis.z()),
                                               fmt::format("motion.angle_deg={}", look_deg * looks),
                                               fmt::format("motion.frames={}", look_deg * looks / frame_deg + 1),
                                               R"(deformers.use=["lbs","pbs","nh_p1"])", "reference.name=nh_p1"});
    turned.joint = of.at("joint");
    turned.claim = what == "twist" ? ArtefactCase::Claim::candy_wrapper : ArtefactCase::Claim::bulge;
    for (int i = 1; i <= looks; ++i)
        turned.poses.push_back(
            {i * look_deg / frame_deg, fmt::format("{} {} deg", what, i * look_deg), {.motion = what, .angle_deg = double(i * look_deg)}});
    return turned;
}

ReadingsCase posed(const StudyCase& of)
{
    const auto along = of.value<std::vector<double>>("jolt_along", {0.0, 1.0, 0.0});
    ReadingsCase posed{.scene = of.scene(),
                       .frame = of.value<int>("frame"),
                       .pose = of.value<std::string>("pose"),
                       .key = {.motion = of.value<std::string>("motion"), .pose = of.value<std::string>("clip_pose", "")},
                       .jolt_direction = {along.at(0), along.at(1), along.at(2)},
                       .most_iterations = of.value<int>("iterations"),
                       .jolt_steps = of.value<int>("jolt_steps"),
                       .timing_s = of.value<double>("timing_s")};
    if (of.has("angle_deg")) posed.key.angle_deg = of.value<double>("angle_deg");
    return posed;
}

StudyRun volume_run(const StudyCase& of, const std::vector<std::string>& claims)
{
    const Scene scene = of.scene();
    const pbs::PbsOptions own = options_of<pbs::PbsOptions>(spec_of(scene, "pbs"));
    const auto which = of.value<std::string>("readings");
    const auto readings = which == "all" ? all_readings(scene) : which == "of_motion" ? readings_of_motion(own) : readings_of_a_step(own);
    VolumeReadings volume{of.value<std::string>("body", "limb"), scene, readings};
    volume.scene.name = of.name;
    StudyRun run = work_run(of.name, volume, of.cost_s, record_volume);
    run.settings.update(judging(readings, claims));
    return run;
}

StudyPlan plan(bool full)
{
    static const std::map<std::string, MeasuredClaims<ReadingsCase>> measures = {{"C03", {{"C03", "C12"}, values_of_starts}},
                                                                                 {"C07", {{"C07"}, values_of_projections}},
                                                                                 {"C09", {{"C09"}, values_of_jolts}},
                                                                                 {"C10", {{"C10"}, values_of_frames}}};
    return plan_of_cases("ambiguity", full, [](const StudyCase& of, StudyPlan& plan) {
        const auto claims = of.value<std::vector<std::string>>("claims");
        std::vector<MeasuredClaims<ReadingsCase>> parts;
        for (const std::string& claim : claims)
            if (measures.contains(claim)) parts.push_back(measures.at(claim));
        if (of.has("turned"))
            plan.runs.push_back(
                claims_run<ArtefactCase>(of.name, turned(of.value<nlohmann::json>("turned")), of.cost_s, {{claims, values_of_sections}}));
        else
            plan.runs.push_back(parts.empty() ? volume_run(of, claims) : claims_run(of.name, posed(of), of.cost_s, parts));
    });
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    const auto changes = finished.rows(claim_change_columns(), "ambiguity.csv");
    const auto volumes = finished.rows(volume_change_columns, "figures.csv");
    finished.write("ambiguity.csv", used_columns(claim_change_columns(), changes), changes);
    finished.write("figures.csv", volume_change_columns, volumes);
    finished.write("figures.md", volumes.empty() ? "" : volume_markdown(volumes));
    const std::string text = changes.empty() ? "" : claim_changes_text(changes);
    finished.write("ambiguity.txt", text);
    return {text, !finished.none()};
}

}  // namespace

Study ambiguity_study()
{
    return {"ambiguity", plan, quick_and_full, conclude};
}

}  // namespace experiments
