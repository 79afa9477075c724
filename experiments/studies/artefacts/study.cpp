// Do the artefacts of blending occur, and how smooth is the skin? Measured are cross-sections of a limb along a joint that is twisted (C04,
// the candy wrapper of LBS) or bent (C05, the bulge of DQS), the weights of Eq. 2 against rigid ones (C06), and the number of
// self-intersections of the skin.
//
//   limb_twist     30 ... 180 deg    o=======o~~~~~~~o      every deformer, and neo-Hookean finite elements:
//   limb_bend      30 ... 150 deg    o=======o              linear elements, in the first poses also quadratic ones
//   BODY_twist_*   45, 90 deg about the bone: elbow, mid-forearm, knee; the tail of frankie, whose knee lies in the belly
//   BODY_bend_*    45, 90 deg in the direction in which the joint bends
//   BODY_crouch    frame 164 of CMU's clip 01_01, all joints of the left side
//
// The quick form has the limb, the human, and the elbow of the others. Quadratic elements have Poisson's ratios 0.45 and 0.49; with --full
// the human has them too.
//
// Writes DIR/artefacts/CASE/{profiles,sections,intersections,smoothness,iterations,measurements}.csv, intersections.md and sections.md.
// The paper states that it does not handle self-intersections; they are counted. sections.md states where C04 and C05 have a value, and why
// they have none elsewhere.
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "experiments/studies/shared/bodies.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <map>

namespace experiments {
namespace {

namespace fs = std::filesystem;

std::string look_and_record(const ArtefactCase& of, const std::string& folder)
{
    const ArtefactBody body(of);
    const ArtefactRecords records = find_artefacts(of, body);
    WeightsComparison weights = compare_weights(of);
    std::vector<analysis::Measurement> measurements = of.claim == ArtefactCase::Claim::candy_wrapper
                                                          ? candy_wrapper_values(of, body, records.samples)
                                                          : bulge_values(of, body, records.samples);
    measurements.insert(measurements.end(), weights.measurements.begin(), weights.measurements.end());
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    table_of(section_columns, section_rows(of, body, section_outcomes(of, body, records.samples))).write(path("sections.csv"));
    table_of(profile_columns, records.profiles).write(path("profiles.csv"));
    table_of(intersection_columns, records.intersections).write(path("intersections.csv"));
    table_of(smoothness_columns, weights.smoothness).write(path("smoothness.csv"));
    table_of(weight_iteration_columns, weights.iterations).write(path("iterations.csv"));
    analysis::measurement_table(measurements).write(path("measurements.csv"));
    return records.breakdown;
}

const char* const all_deformers = R"(deformers.use=["lbs","dqs","pbs","delta_mush","xpbd","nh_p1"])";
const char* const with_second_order = R"(deformers.use=["lbs","dqs","pbs","delta_mush","xpbd","nh_p1","nh_p2","nh_p2_nu_049"])";

// A sweep in equal steps, without the rest pose.
ArtefactCase sweep(const std::string& scene, std::vector<std::string> overrides, const std::string& what, int step_deg, int poses)
{
    ArtefactCase of;
    overrides.push_back(fmt::format("motion.angle_deg={}", step_deg * poses));
    overrides.push_back(fmt::format("motion.frames={}", poses + 1));
    overrides.push_back("reference.name=nh_p1");
    of.scene = read_scene(scene, overrides);
    of.claim = what == "twist" ? ArtefactCase::Claim::candy_wrapper : ArtefactCase::Claim::bulge;
    for (int i = 1; i <= poses; ++i)
        of.poses.push_back({i, fmt::format("{}_{}_deg", what, i * step_deg), {.motion = what, .angle_deg = double(i * step_deg)}});
    return of;
}

ArtefactCase limb_sweep(const std::string& what, int poses, bool full)
{
    ArtefactCase of = sweep("limb_" + what, {with_second_order}, what, 30, poses);
    of.vertices = full ? std::vector<int>{1200, 2600} : std::vector<int>{1200};
    of.second_order_poses = full ? (what == "twist" ? poses : 3) : 2;  // beyond a bend of 90 degrees a pose takes minutes
    return of;
}

// The human alone has quadratic elements.
const char* deformers_of(const std::string& body, bool full)
{
    return full && body == "human" ? with_second_order : all_deformers;
}

ArtefactCase body_sweep(const std::string& body, const pbs::Skeleton& skeleton, const LimbJoint& joint, const std::string& what, bool full)
{
    const pbs::Vec3 axis = what == "twist" ? twist_axis(skeleton, joint) : hinge_axis(skeleton, joint);
    ArtefactCase of = sweep("limb_bend",
                            {deformers_of(body, full), "character.body=" + body, "motion.joint=" + skeleton.bones[joint.child].name,
                             fmt::format("motion.axis=[{:.9f},{:.9f},{:.9f}]", axis.x(), axis.y(), axis.z())},
                            what, 45, 2);
    of.joint = joint.name;
    of.second_order_poses = 2;
    return of;
}

ArtefactCase crouch(const std::string& body, bool full)
{
    ArtefactCase of;
    of.scene = read_scene("human_01_01", {deformers_of(body, full), "character.body=" + body, "reference.name=nh_p1"});
    of.poses = {{crouch_frame, "01_01_crouch", {.motion = "01_01", .pose = "crouch"}}};
    of.second_order_poses = 1;
    return of;
}

// How the joints of the bodies are turned, by the human's names of bones. A body with other names has all of its joints turned.
struct TurnedJoint {
    enum class QuickFor { no_body, human, every_body };

    std::string name;
    bool twisted, bent;
    QuickFor quick_for;

    bool is_turned(const std::string& body, bool full) const
    {
        return full || quick_for == QuickFor::every_body || (quick_for == QuickFor::human && body == "human");
    }
};
const TurnedJoint turned_joints[] = {{"upper_arm.L|forearm_upper.L", true, true, TurnedJoint::QuickFor::every_body},
                                     {"forearm_upper.L|forearm_lower.L", true, false, TurnedJoint::QuickFor::no_body},
                                     {"thigh.L|shin.L", true, true, TurnedJoint::QuickFor::human},
                                     {"tail_2|tail_3", true, true, TurnedJoint::QuickFor::no_body}};

std::vector<TurnedJoint> joints_to_turn(const std::vector<LimbJoint>& joints)
{
    std::vector<TurnedJoint> turned, all;
    for (const LimbJoint& joint : joints) {
        all.push_back({joint.name, true, true, TurnedJoint::QuickFor::every_body});
        for (const TurnedJoint& known : turned_joints)
            if (known.name == joint.name) turned.push_back(known);
    }
    return turned.empty() ? all : turned;
}

void plan_body(const std::string& body, bool full, StudyPlan& plan)
{
    const pbs::Character character = pbs::make_character({.body = body});
    const std::vector<LimbJoint> joints = limb_joints(character);
    const int finer = static_cast<int>(1.3 * static_cast<double>(character.mesh.rest.rows()));
    const auto add = [&](const std::string& name, ArtefactCase of, double cost_s) {
        if (full) of.vertices = {finer};
        plan.runs.push_back(work_run(name, of, full ? 1.5 * cost_s : cost_s, look_and_record));
    };
    for (const TurnedJoint& turned : joints_to_turn(joints))
        for (const LimbJoint& joint : joints) {
            if (joint.name != turned.name || !turned.is_turned(body, full)) continue;
            const std::string& bone = character.skeleton.bones[joint.child].name;
            if (turned.twisted) add(body + "_twist_" + bone, body_sweep(body, character.skeleton, joint, "twist", full), 4.0);
            if (turned.bent) add(body + "_bend_" + bone, body_sweep(body, character.skeleton, joint, "bend", full), 4.0);
        }
    if (full || body == "human") add(body + "_crouch", crouch(body, full), body == "frankie" ? 8.0 : 4.0);
}

struct RunIntersection {
    std::string run;
    IntersectionRow row;
};

// The surfaces on which a pose changes the number of pairs of triangles that intersect.
std::string intersections_text(const FinishedRuns& finished)
{
    static const analysis::Columns<RunIntersection> columns =
        analysis::Columns<RunIntersection>{{"run", &RunIntersection::run, "", "name of the run"}} +
        analysis::within(&RunIntersection::row, intersection_columns);
    std::vector<RunIntersection> changed;
    for (const std::string& file : finished.files("intersections.csv"))
        for (const auto& row : rows_of(intersection_columns, analysis::read_csv(file)))
            if (row.pairs != row.pairs_at_rest) changed.push_back({fs::path(file).parent_path().filename().string(), row});
    return markdown_table(table_of(columns, changed), {{"case", "run"},
                                                       {"pose", "pose"},
                                                       {"surface", "surface"},
                                                       {"deformer", "deformer"},
                                                       {"pairs", "pairs"},
                                                       {"at rest", "pairs_at_rest"}});
}

// The number of sections by which each claim is judged, those that are left out with the reason, and the remarks.
std::string sections_text(const FinishedRuns& finished)
{
    std::map<std::string, std::map<std::string, std::vector<std::string>>> sections;  // by claim and outcome
    std::string remarks;
    for (const SectionRow& row : finished.rows(section_columns, "sections.csv")) {
        const std::string of = fmt::format("{} {} {}", row.body, row.pose, row.joint);
        sections[row.claim][row.outcome].push_back(of);
        if (!row.remark.empty()) remarks += fmt::format("{}: {}, {}: {}\n", row.claim, of, row.outcome, row.remark);
    }
    std::string text;
    for (const auto& [claim, outcomes] : sections)
        for (const auto& [outcome, names] : outcomes) {
            text += fmt::format("{}: {} sections {}", claim, names.size(), outcome);
            text += outcome == name_of(SectionOutcome::measured) ? "\n" : fmt::format(": {}\n", fmt::join(names, "; "));
        }
    return text + remarks;
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(work_run("limb_twist", limb_sweep("twist", 6, full), full ? 26.0 : 11.0, look_and_record));
    plan.runs.push_back(work_run("limb_bend", limb_sweep("bend", 5, full), full ? 60.0 : 40.0, look_and_record));
    for_each_installed_body(plan.left_out, [&](const std::string& body) { plan_body(body, full, plan); });
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    const std::string intersections = intersections_text(finished), sections = sections_text(finished);
    finished.write("intersections.md", intersections);
    finished.write("sections.md", sections);
    return {intersections + "\n" + sections, !finished.none()};
}

}  // namespace

Study artefacts_study()
{
    return {"artefacts", plan, quick_and_full, conclude};
}

}  // namespace experiments
