// A tetrahedral mesh in rest pose.
#pragma once

#include "pbs/geometry/types.hpp"

namespace pbs {

// read_tet_mesh checks what it reads; of meshes made by hand PbsSolver asks indices in range and positive volumes, most functions nothing.
struct TetMesh {
    Positions rest;  // rest positions [m], #V x 3
    Tets tets;       // #T x 4, positively oriented: (p2-p1) x (p3-p1) . (p4-p1) > 0
};

}  // namespace pbs
