// Checks of the reference solver's input. Each violation is a pbs::InputError that names the field, the value and the rule.
#pragma once

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <cmath>
#include <sstream>

namespace reference_fem {

// Throws unless it holds; without file and line, since the input is arrays.
template <typename Value>
void require(bool holds, const char* field, const Value& value, const char* rule)
{
    if (holds) return;
    std::ostringstream text;
    text << value;
    throw pbs::InputError("", 0, field, text.str(), rule);
}

// Finite points, vertex indices in range, every tet of positive volume, every vertex used.
void check_mesh(const pbs::TetMesh& mesh);

}  // namespace reference_fem
