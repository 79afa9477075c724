// make_character with what was accepted in a mesh from a file although its author may not have meant it (mesh_remarks.hpp).
//   std::vector<std::string> remarks;
//   const Character arm = make_character({.mesh_file = "arm.msh", .skeleton_file = "arm.skeleton.toml"}, remarks);
#pragma once

#include "pbs/character/bodies.hpp"

#include <string>
#include <vector>

namespace pbs {

// One line each: turned tets, parts, an extent that speaks for other units than metres; none of a body by name.
Character make_character(const CharacterSource& source, std::vector<std::string>& remarks);

}  // namespace pbs
