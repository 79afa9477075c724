// The tree that named joints make: who stands under whom, parents before children.
#pragma once

#include "pbs/skinning/skeleton.hpp"

#include <string>
#include <vector>

namespace pbs {

// A joint as it stands in a skeleton file, and the line it begins at.
struct NamedJoint {
    // Given once.
    std::string name, parent;  // parent "": a root
    // Where it turns [m].
    Vec3 head, tail;  // where its bone ends [m]
    int line = 0;     // for errors; 0: not known
};

// Checked (duplicate names, unknown parents, cycles, no root, bones without length) and sorted; the file's order is kept where it can be.
Skeleton order_skeleton(const std::vector<NamedJoint>& joints, const std::string& file);

}  // namespace pbs
