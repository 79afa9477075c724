// The cases on which kernels are compared with their plain counterparts: sizes, stiffnesses, well-shaped and degenerate tets.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <string>

namespace test_support {

inline const double sizes_m[] = {1e-6, 1e-3, 1.0, 1e3, 1e6};
inline const double stiffnesses[] = {0.0, 0.3, 1.0};

// The corners of a tet, and the points that may follow around its first edge; any three neighbours in the ring make a well-shaped tet.
inline const pbs::Vec3 ring[] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {0, 1, 0.5}, {-1, 0.1, 0.5}, {-0.3, -1, 0.5}};

struct TetShape {
    std::string name;
    std::array<pbs::Vec3, 4> corners;  // dyadic coordinates where products must cancel exactly
};
inline const TetShape degenerate_tets[] = {
    {"flat", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}},
    {"a corner on the opposite face", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0}}}},
    {"two corners coincide", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}}},
    {"three corners coincide", {{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}},
    {"a line", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0.5, 0, 0}}}},
    {"a point", {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}},
    {"nearly flat", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1e-3}}}},
    {"a sliver", {{{0, 0, 0}, {1, 0, 0}, {0.5, 0.01, 0}, {0.5, 0, 0.01}}}},
    {"a hundred times too large", {{{0, 0, 0}, {100, 0, 0}, {0, 100, 0}, {0, 0, 100}}}},
};

}  // namespace test_support
