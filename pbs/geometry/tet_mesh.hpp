// A tetrahedral mesh in rest pose.
#pragma once

#include "pbs/geometry/types.hpp"

namespace pbs {

// read_tet_mesh checks what it reads. For other meshes PbsSolver checks that indices are in range and volumes positive; most functions
// check nothing.
struct TetMesh {
    Positions rest;  // rest positions [m], #V x 3
    Tets tets;       // #T x 4, positively oriented: (p2-p1) x (p3-p1) . (p4-p1) > 0
};

}  // namespace pbs
