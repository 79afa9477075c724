// The unit tet, the smallest possible mesh: vertices at the origin and at 1 m on each axis, one positively oriented tet of 1/6 m^3 with
// three edges of 1 m and three of sqrt 2 m.
//   const pbs::TetMesh mesh = test_support::unit_tet();
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace test_support {

inline pbs::TetMesh unit_tet()
{
    return {pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, pbs::Tets{{0, 1, 2, 3}}};
}

// The unit tet and a second one below it on the triangle 0 1 2, of `depth_m` / 6 m^3.
inline pbs::TetMesh two_tets(double depth_m = 1.0)
{
    return {pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -depth_m}}, pbs::Tets{{0, 1, 2, 3}, {0, 2, 1, 4}}};
}

}  // namespace test_support
