// The tree of named joints: the parent of each joint, parents before children.
#pragma once

#include "pbs/skinning/pose.hpp"

#include <string>
#include <vector>

namespace pbs {

// A joint as a skeleton file describes it, and the line at which it begins.
struct NamedJoint {
    // Given once.
    std::string name, parent;  // parent "": a root
    // The centre of its rotation [m].
    Vec3 head, tail;  // where its bone ends [m]
    int line = 0;     // for errors; 0: not known
};

// Checked (duplicate names, unknown parents, cycles, no root, bones without length) and sorted; the file's order is kept where it can be.
Skeleton order_skeleton(const std::vector<NamedJoint>& joints, const std::string& file);

}  // namespace pbs
