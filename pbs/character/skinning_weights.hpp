// The rules by which the vertices of a character get their skinning weights.
#pragma once

#include "pbs/character/character.hpp"

namespace pbs {

// Weights of the character's tets by a rule. artist: those that a rigged file brought, and file: those of its weights file; an InputError
// where the character has none. Two controls for Eq. 2, whose weights jump from vertex to vertex. smooth: weights as of Eq. 2
// where it gives a vertex to one bone alone, harmonic between. They still jump where two such vertices of different bones are neighbours.
// diffused: those of Eq. 2, smoothed eight times over the mesh's edges (weights.hpp): smooth everywhere, over about two edges of
// the mesh. On the human in clip 01_01, LBS inverts 93 tets per frame with the weights of Eq. 2, 81 with smooth and 0.2 with diffused ones.
Weights weights_by(WeightKind kind, const Character& character);

// The character with weights by another rule; everything else is kept.
Character with_weights(WeightKind kind, Character character);

bool has_artist_weights(const Character& character);

const char* name_of(WeightKind kind);  // paper, rigid, smooth, diffused, artist, file

}  // namespace pbs
