#include "experiments/run/bone_record.hpp"

namespace experiments {

analysis::CsvTable empty_bone_table()
{
    return analysis::CsvTable(
        {"frame", "time_s", "bone", "parent", "head_x_m", "head_y_m", "head_z_m", "tail_x_m", "tail_y_m", "tail_z_m"});
}

void add_bones(analysis::CsvTable& bones, int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose)
{
    for (std::size_t j = 0; j < skeleton.bones.size(); ++j) {
        const pbs::Bone& bone = skeleton.bones[j];
        const pbs::Vec3 head = pose[j] * bone.head, tail = pose[j] * bone.tail;
        bones.add_row({frame, time_s, bone.name, bone.parent < 0 ? "" : skeleton.bones[bone.parent].name, head.x(), head.y(), head.z(),
                       tail.x(), tail.y(), tail.z()});
    }
}

analysis::CsvTable rest_bone_table(const pbs::Skeleton& skeleton)
{
    analysis::CsvTable bones({"bone", "parent", "head_x_m", "head_y_m", "head_z_m", "tail_x_m", "tail_y_m", "tail_z_m"});
    for (const pbs::Bone& bone : skeleton.bones)
        bones.add_row({bone.name, bone.parent < 0 ? "" : skeleton.bones[bone.parent].name, bone.head.x(), bone.head.y(), bone.head.z(),
                       bone.tail.x(), bone.tail.y(), bone.tail.z()});
    return bones;
}

analysis::CsvTable binding_table(const pbs::Character& character)
{
    analysis::CsvTable table({"vertex", "bone", "parameter", "rest_distance_m", "blended", "jiggles"});
    const pbs::BoneBinding& binding = character.binding;
    const std::vector<bool> jiggles = pbs::jiggle_zone(binding);
    for (std::size_t v = 0; v < binding.bone.size(); ++v)
        table.add_row({int(v), character.skeleton.bones[binding.bone[v]].name, binding.parameter(v), binding.distance(v),
                       int(character.blended[v]), int(jiggles[v])});
    return table;
}

}  // namespace experiments
