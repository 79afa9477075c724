// The same character on finer tets: what any deformer is run on to learn how much its own mesh matters.
//   const Character fine = refined(character);   // its first #V vertices are those of `character`
// Skeleton and bones' sizes (Character::unrefined) stay; binding and weights follow the same rules on the finer mesh, a weights file's from
// the mean of the two vertices that a new one lies between; the rendered surface stays where it is. A rule that asks for the nearest bone
// jumps between vertices, so that a finer mesh shows Eq. 2's jumps more sharply: its limit is a jump.
#pragma once

#include "pbs/character/character.hpp"

namespace pbs {

// Eight times the tets; Character::refinements is one higher.
Character refined(const Character& character);

}  // namespace pbs
