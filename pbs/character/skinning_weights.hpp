// The rules by which the vertices of a character get their skinning weights.
#pragma once

#include "pbs/character/character.hpp"

namespace pbs {

// Weights of the character's tets by a rule. artist: those that a rigged file brought, and file: those of its weights file; an InputError
// where the character has none. smooth: a control for Eq. 2: weights as of Eq. 2 where it gives a vertex to one bone alone, harmonic
// between.
Weights weights_by(WeightKind kind, const Character& character);

// The character with weights by another rule; everything else is kept.
Character with_weights(WeightKind kind, Character character);

bool has_artist_weights(const Character& character);

const char* name_of(WeightKind kind);  // paper, rigid, smooth, artist, file

}  // namespace pbs
