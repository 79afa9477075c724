#include "experiments/studies/reference_poses.hpp"

#include "experiments/settings/recorded_settings.hpp"

namespace experiments {

RECORD_SETTINGS(ReferencePose, name, of, stratum, scene, frame)

namespace {

constexpr int frames_of_a_movement = 10;  // the last one is the end of the range

}  // namespace

ReferencePose reference_pose(const StudyCase& in_file)
{
    ReferencePose pose{.name = in_file.name, .of = in_file.key()};
    pose.stratum = option_of<Stratum>(in_file.value<std::string>("stratum"));
    if (!in_file.has("movement")) {
        pose.scene = in_file.scene();
        pose.frame = in_file.value<int>("frame");
        return pose;
    }
    pose.frame = frames_of_a_movement - 1;
    pose.scene = read_scene("human_01_01", {"character.body=" + pose.of.body, "motion.clip=",
                                            "motion.movements=['" + in_file.value<std::string>("movement") + "']",
                                            "motion.frames=" + std::to_string(frames_of_a_movement)});
    return pose;
}

bool is_played(const EnsembleMember& member)
{
    return member.name == "smooth" || member.name == "rigid_capsules";
}

std::vector<EnsembleMember> members_of(Stratum stratum)
{
    std::vector<EnsembleMember> members = family();
    if (stratum == Stratum::played)
        std::erase_if(members, [](const EnsembleMember& member) { return !is_played(member); });
    return members;
}

std::vector<ReferencePose> reference_poses()
{
    std::vector<ReferencePose> poses;
    plan_of_cases("references", true, [&](const StudyCase& in_file, StudyPlan&) {
        if (!in_file.has("learned_from")) poses.push_back(reference_pose(in_file));
    });
    return poses;
}

pbs::Pose bones_in(const ReferencePose& pose, const pbs::Skeleton& skeleton)
{
    const pbs::Motion motion = make_motion(pose.scene.motion, skeleton, pose.scene.file);
    return motion.steps.at(static_cast<std::size_t>(pose.frame) * motion.steps_per_frame);
}

}  // namespace experiments
