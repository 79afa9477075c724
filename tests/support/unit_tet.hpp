// The unit tet, the smallest possible mesh: vertices at the origin and at 1 m on each axis, one positively oriented tet of 1/6 m^3 with
// three edges of 1 m and three of sqrt 2 m.
//   const pbs::TetMesh mesh = test_support::unit_tet();
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace test_support {

inline pbs::TetMesh unit_tet()
{
    pbs::TetMesh mesh{pbs::Positions(4, 3), pbs::Tets(1, 4)};
    mesh.rest << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    mesh.tets << 0, 1, 2, 3;
    return mesh;
}

}  // namespace test_support
