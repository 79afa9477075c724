// The bones of a run's frames and what binds the vertices to them, for programs that draw the frames: bones.csv, bones_rest.csv and
// binding.csv. The columns explain their contents.
#pragma once

#include "analysis/records/tables.hpp"
#include "pbs/character/character.hpp"

namespace experiments {

struct BonePlace {
    std::string bone, parent;
    pbs::Vec3 head, tail;  // [m]
};
struct PosedBone {
    int frame = 0;
    double time_s = 0.0;
    BonePlace place;
};
struct BoundVertex {
    int vertex = 0;
    std::string bone;
    double parameter = 0.0, rest_distance_m = 0.0;
    bool blended = false, jiggles = false;
};

extern const analysis::Columns<BonePlace> bone_columns;            // bones_rest.csv
extern const analysis::Columns<PosedBone> posed_bone_columns;      // bones.csv: every bone in each frame that is written
extern const analysis::Columns<BoundVertex> bound_vertex_columns;  // binding.csv

std::vector<BonePlace> bones_at_rest(const pbs::Skeleton& skeleton);
void add_bones(std::vector<PosedBone>& bones, int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose);
std::vector<BoundVertex> bound_vertices(const pbs::Character& character);

}  // namespace experiments
