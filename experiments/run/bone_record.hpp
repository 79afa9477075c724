// What a run's frames hang on, for whoever draws them:
//   bones.csv       frame, time_s, bone, parent, head_x_m ... tail_z_m   every bone where the pose puts it, in each frame that is written
//   bones_rest.csv  bone, parent, head_x_m ... tail_z_m   the same bones at rest
//   binding.csv     vertex, bone, parameter, rest_distance_m, blended, jiggles   Sec. 2.1: each vertex's nearest bone, where on it (0 at
//                   its head, 1 at its tail) and how far from it at rest; blended: by Eq. 2, between bones; jiggles: farther than the mean
#pragma once

#include "analysis/records/csv_table.hpp"
#include "pbs/character/character.hpp"

namespace experiments {

analysis::CsvTable empty_bone_table();
analysis::CsvTable rest_bone_table(const pbs::Skeleton& skeleton);
void add_bones(analysis::CsvTable& bones, int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose);

analysis::CsvTable binding_table(const pbs::Character& character);

}  // namespace experiments
