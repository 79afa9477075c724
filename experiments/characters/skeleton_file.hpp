// The skeleton TOML: a table [[joint]] per bone with name, parent ("" for a root), head_m and tail_m.
//   const Skeleton skeleton = parse_skeleton(pbs::read_text_file("arm.skeleton.toml"), "arm.skeleton.toml");
#pragma once

#include "pbs/skinning/pose.hpp"

#include <functional>
#include <string>
#include <vector>

namespace pbs {

// Reads a skeleton. Coordinates are in metres; bones come parents first, else in the order of the file. `name` stands
// for the file in errors. InputError, by line, for a text that is no TOML; a key that is unknown, missing or of another
// type; a coordinate that is not finite or is beyond 1e9 m; a name that is empty or given twice; a parent that does not
// exist (the nearest name is stated); a cycle; no root; a bone without length; no joint, or more than 2,000. In a build
// without PBS_WITH_RIG_IMPORT, every text is an InputError.
Skeleton parse_skeleton(const std::string& text, const std::string& name);  // `name` stands for the file in errors

// A joint as a skeleton file describes it, and the line at which it begins.
struct NamedJoint {
    std::string name, parent;  // each name once; parent "": a root
    Vec3 head, tail;           // the centre of its rotation, and where its bone ends [m]
    int line = 0;              // for errors; 0: not known
};

// Checked (duplicate names, unknown parents, cycles, no root, bones without length) and sorted; the file's order is
// kept where it can be.
Skeleton order_skeleton(const std::vector<NamedJoint>& joints, const std::string& file);

// A rig of many joints folded to fewer bones: each end of a bone is the mean of named points of the rig.
//   Skeleton skeleton = fold_skeleton({{"thigh.*", "pelvis", {"hip.*"}, {"knee.*"}}, ...}, "rig.json", point_named);
// A star in a name stands for L and R, so that one entry describes two bones. parent "": the root.
struct FoldedBone {
    std::string name, parent;             // which may contain a star; parent "": the root
    std::vector<std::string> head, tail;  // points of the rig, whose means are the bone's ends
};

// Bones in the middle first, then those of the left, then those of the right. `file` stands for the rig in errors.
Skeleton fold_skeleton(const std::vector<FoldedBone>& bones, const std::string& file,
                       const std::function<Vec3(const std::string& point)>& point_named);

}  // namespace pbs
