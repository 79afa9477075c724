// Do the artefacts of blending occur, and how smooth is the skin? Measured are cross-sections of a limb along a joint that is twisted (C04,
// the candy wrapper of LBS) or bent (C05, the bulge of DQS), the weights of Eq. 2 against rigid ones (C06), and the number of
// self-intersections of the skin, which the paper states that it does not handle. README.md describes the runs and records.
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
#include <optional>

namespace experiments {
namespace {

std::string look_and_record(const ArtefactCase& of, const std::string& folder)
{
    const ArtefactBody body(of);
    const ArtefactRecords records = find_artefacts(of, body);
    WeightsComparison weights = compare_weights(of);
    std::vector<analysis::Measurement> measurements = section_values(of, body, records.samples);
    measurements.insert(measurements.end(), weights.measurements.begin(), weights.measurements.end());
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    table_of(section_columns, section_rows(of, body, section_outcomes(of, body, records.samples))).write(path("sections.csv"));
    table_of(profile_columns, records.profiles).write(path("profiles.csv"));
    table_of(intersection_columns, records.intersections).write(path("intersections.csv"));
    table_of(smoothness_columns, weights.smoothness).write(path("smoothness.csv"));
    analysis::measurement_table(measurements).write(path("measurements.csv"));
    return records.breakdown;
}

// A joint that turns by step_deg from pose to pose, without the rest pose, one pose of a clip, or a movement halfway and
// at its end.
ArtefactCase case_of(const StudyCase& of, const std::string& movement = "")
{
    ArtefactCase made;
    made.joint = of.value<std::string>("joint", "");
    made.vertices = of.value<std::vector<int>>("vertices", {});
    made.second_order_poses = of.value("second_order_poses", 0);
    const double finer = of.value("finer", 0.0);  // a further mesh, by its size over that of the body's own
    std::optional<pbs::Character> character;
    if (finer > 0.0 || !made.joint.empty()) character = pbs::make_character(of.scene().character);
    if (finer > 0.0) made.vertices.push_back(static_cast<int>(finer * static_cast<double>(character->mesh.rest.rows())));
    Overrides overrides;
    if (of.has("frame"))
        made.poses = {{of.value<int>("frame"), of.key().motion + "_" + of.key().pose, {.motion = of.key().motion, .pose = of.key().pose}}};
    else if (!movement.empty()) {
        made.claim = option_of<ArtefactCase::Claim>(of.value<std::string>("claim"));
        overrides = {fmt::format("motion.movements=['{}']", movement), "motion.frames=2"};
        for (const auto& [frame, name] : {std::pair{1, "halfway_to_" + movement}, {2, movement}})
            made.poses.push_back({frame, name, {.motion = "range_of_motion", .pose = name}, joints_of(movement)});
    } else {
        const auto what = of.value<std::string>("what");
        const int step_deg = of.value<int>("step_deg"), poses = of.value<int>("poses"), frame_deg = of.value("frame_deg", step_deg);
        made.claim = what == "twist" ? ArtefactCase::Claim::candy_wrapper : ArtefactCase::Claim::bulge;
        overrides.push_back(fmt::format("motion.angle_deg={}", step_deg * poses));
        overrides.push_back(fmt::format("motion.frames={}", step_deg * poses / frame_deg + 1));
        for (int i = 1; i <= poses; ++i)
            made.poses.push_back({i * step_deg / frame_deg,
                                  fmt::format("{}_{}_deg", what, i * step_deg),
                                  {.motion = what, .angle_deg = double(i * step_deg)}});
        if (!made.joint.empty()) {
            const std::vector<LimbJoint> joints = limb_joints(*character);
            const auto joint = std::ranges::find(joints, made.joint, &LimbJoint::name);
            if (joint == joints.end())
                throw pbs::InputError(character->name, 0, "joint", made.joint, "expected it among the body's joints");
            const pbs::Vec3 axis = what == "twist" ? twist_axis(character->skeleton, *joint) : hinge_axis(character->skeleton, *joint);
            overrides.push_back("motion.joint=" + character->skeleton.bones[joint->child].name);
            overrides.push_back(fmt::format("motion.axis=[{:.9f},{:.9f},{:.9f}]", axis.x(), axis.y(), axis.z()));
        }
    }
    made.scene = of.scene(overrides);
    return made;
}

// C04 or C05 of readings: sections in the poses of a sweep all steps of which are taken, and one reference.
std::vector<ReadingValues> read_sections(const StudyCase& of, const std::vector<Overrides>& readings)
{
    const ArtefactCase base = case_of(of);
    const ArtefactBody body(base);
    const pbs::Character& character = body.posed.character();
    const pbs::Motion motion = make_motion(base.scene.motion, character.skeleton, base.scene.file);
    const auto add = [&](std::vector<ArtefactSample>& samples, const char* group, std::size_t pose, const pbs::Positions& shape) {
        const int element_order = group == std::string("reference") ? 1 : 0;
        for (std::size_t joint = 0; joint < body.joints.size(); ++joint)
            samples.push_back({group, pose, joint, extremes_of(body.sections[joint].measure(shape, body.posed.pose(pose))), element_order});
    };
    std::vector<ArtefactSample> reference;
    const Shapes flesh = body.posed.shapes(spec_of(base.scene, base.scene.reference));
    for (std::size_t pose = 0; pose < flesh.size(); ++pose)
        if (flesh[pose].finished) add(reference, "reference", pose, flesh[pose].positions);
    std::vector<ReadingValues> all;
    for (const Overrides& reading : readings) {
        const Scene scene = of.scene(reading);
        const std::vector<pbs::Positions> shapes = shapes_in_motion(reweighted(character, scene), motion, spec_of(scene, "pbs"));
        std::vector<ArtefactSample> samples = reference;
        for (std::size_t pose = 0; pose < base.poses.size(); ++pose)
            if (const pbs::Positions& shape = shapes.at(static_cast<std::size_t>(base.poses[pose].frame)); shape.allFinite())
                add(samples, "pbs", pose, shape);
        const bool finite = std::ranges::all_of(shapes, [](const pbs::Positions& shape) { return shape.allFinite(); });
        all.push_back({section_values(base, body, samples), !finite});
    }
    return all;
}

StudyPlan plan(bool full)
{
    return plan_of_cases("artefacts", full, [](const StudyCase& of, StudyPlan& plan) {
        if (!of.has("movements")) plan.runs.push_back(work_run(of.name, case_of(of), of.cost_s, look_and_record));
        for (const auto& movement : of.value<std::vector<std::string>>("movements", {}))
            plan.runs.push_back(work_run(of.name + "_" + movement, case_of(of, movement), of.cost_s, look_and_record));
    });
}

}  // namespace

Study artefacts_study()
{
    return {"artefacts", plan, quick_and_full, nullptr, false, nullptr, read_sections};
}

}  // namespace experiments
