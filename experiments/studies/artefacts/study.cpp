// Do the artefacts of blending occur, and how smooth is the skin? Measured are cross-sections of a limb along a joint
// that is twisted (C04, the candy wrapper of LBS) or bent (C05, the bulge of DQS), the weights of Eq. 2 against rigid
// ones (C06), and the number of self-intersections of the skin, which the paper states that it does not handle.
// README.md describes the runs and records.
//
//   limb_twist     30 ... 180 deg    o=======o~~~~~~~o
//   limb_bend      30 ... 150 deg    o=======o
#include "analysis/records/record_files.hpp"
#include "experiments/scene/movements.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace experiments {
namespace {

std::string look_and_record(const ArtefactCase& artefact_case, const std::string& folder)
{
    const ArtefactBody body(artefact_case);
    const ArtefactRecords records = find_artefacts(artefact_case, body);
    const WeightsComparison weights =
        artefact_case.through_sweep ? WeightsComparison{} : compare_weights(artefact_case);
    std::vector<analysis::Measurement> measurements = section_values(artefact_case, body, records.samples);
    measurements.insert(measurements.end(), weights.measurements.begin(), weights.measurements.end());
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    table_of(section_columns, section_rows(artefact_case, body, section_outcomes(artefact_case, body, records.samples)))
        .write(path("sections.csv"));
    table_of(profile_columns, records.profiles).write(path("profiles.csv"));
    table_of(intersection_columns, records.intersections).write(path("intersections.csv"));
    table_of(smoothness_columns, weights.smoothness).write(path("smoothness.csv"));
    analysis::measurement_table(measurements).write(path("measurements.csv"));
    return records.breakdown;
}

// The bodies of cases without their surfaces, whose embedding takes most of the time. Each is made once.
class CaseBodies {
public:
    const pbs::Character& body(const Scene& scene)
    {
        pbs::CharacterSource source = scene.character;
        source.surface = false;
        auto& body = bodies_[{source.body, source.vertices}];  // the cases of this study state nothing else of a body
        if (!body) body = pbs::make_character(source);
        return *body;
    }

private:
    std::map<std::pair<std::string, int>, std::optional<pbs::Character>> bodies_;
};

// A joint that turns by step_deg from pose to pose, without the rest pose, one pose of a clip, or a movement halfway
// and at its end.
ArtefactCase case_of(const StudyCase& study_case, CaseBodies& bodies, const std::string& movement = "")
{
    ArtefactCase made;
    made.joint = study_case.value<std::string>("joint", "");
    made.vertices = study_case.value<std::vector<int>>("vertices", {});
    made.second_order_poses = study_case.value("second_order_poses", 0);
    made.through_sweep = study_case.value("through_sweep", false);
    const double finer = study_case.value("finer", 0.0);  // a further mesh, by its size over that of the body's own
    const auto character = [&]() -> const pbs::Character& { return bodies.body(study_case.scene()); };
    if (finer > 0.0)
        made.vertices.push_back(static_cast<int>(finer * static_cast<double>(character().mesh.rest.rows())));
    Overrides overrides;
    if (study_case.has("frame"))
        made.poses = {{study_case.value<int>("frame"),
                       study_case.key().motion + "_" + study_case.key().pose,
                       {.motion = study_case.key().motion, .pose = study_case.key().pose}}};
    else if (!movement.empty()) {
        made.claim = option_of<ArtefactCase::Claim>(study_case.value<std::string>("claim"));
        overrides = {fmt::format("motion.movements=['{}']", movement), "motion.frames=2"};
        for (const auto& [frame, name] : {std::pair{1, "halfway_to_" + movement}, {2, movement}})
            made.poses.push_back({frame, name, {.motion = "range_of_motion", .pose = name}, joints_of(movement)});
    } else {
        const auto what = study_case.value<std::string>("what");
        const int step_deg = study_case.value<int>("step_deg"), poses = study_case.value<int>("poses"),
                  frame_deg = study_case.value("frame_deg", step_deg);
        made.claim = what == "twist" ? ArtefactCase::Claim::candy_wrapper : ArtefactCase::Claim::bulge;
        overrides.push_back(fmt::format("motion.angle_deg={}", step_deg * poses));
        overrides.push_back(fmt::format("motion.frames={}", step_deg * poses / frame_deg + 1));
        for (int i = 1; i <= poses; ++i)
            made.poses.push_back({i * step_deg / frame_deg,
                                  fmt::format("{}_{}_deg", what, i * step_deg),
                                  {.motion = what, .angle_deg = double(i * step_deg)}});
        if (!made.joint.empty()) {
            const std::vector<LimbJoint> joints = limb_joints(character());
            const auto joint = std::ranges::find(joints, made.joint, &LimbJoint::name);
            if (joint == joints.end())
                throw pbs::InputError(character().name, 0, "joint", made.joint, "expected it among the body's joints");
            const pbs::Vec3 axis =
                what == "twist" ? twist_axis(character().skeleton, *joint) : hinge_axis(character().skeleton, *joint);
            overrides.push_back("motion.joint=" + character().skeleton.bones[joint->child].name);
            overrides.push_back(fmt::format("motion.axis=[{:.9f},{:.9f},{:.9f}]", axis.x(), axis.y(), axis.z()));
        }
    }
    made.scene = study_case.scene(overrides);
    return made;
}

void add_runs(const StudyCase& study_case, CaseBodies& bodies, StudyPlan& plan)
{
    if (!study_case.has("movements"))
        plan.runs.push_back(work_run(study_case.name, case_of(study_case, bodies), study_case.cost_s, look_and_record));
    for (const auto& movement : study_case.value<std::vector<std::string>>("movements", {}))
        plan.runs.push_back(work_run(study_case.name + "_" + movement, case_of(study_case, bodies, movement),
                                     study_case.cost_s, look_and_record));
}

void add_case(const StudyCase& study_case, StudyPlan& plan)
{
    CaseBodies bodies;
    add_runs(study_case, bodies, plan);
}

StudyPlan plan(bool full)
{
    CaseBodies bodies;
    return plan_of_cases("artefacts", full, [&bodies](const StudyCase& study_case, StudyPlan& plan) {
        add_runs(study_case, bodies, plan);
    });
}

}  // namespace

Study artefacts_study()
{
    return {"artefacts", plan, quick_and_full, nullptr, false, nullptr, add_case};
}

}  // namespace experiments
