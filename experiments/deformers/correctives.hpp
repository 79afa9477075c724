// Fitted correctives as a file, and the options of the deformer that reads it. `pbskin try MODEL --bake` writes the
// file.
//   pbs::write_atomically("hero/correctives.toml", text_of(correctives, character));
//   const pbs::Correctives correctives = parse_correctives(text, "hero/correctives.toml", character);
//
// It is a TOML file: `schema` (1); `character`, by its name; `tets_hash` and `rig_hash`, of the character's tets, and
// of its bones and skinning weights; `content_hash`, of all that follows its line; `unit_m`, 5e-6 of the body's size;
// the features `lowest` and `highest` of the training, a row per bone; and a table [[joint]] per joint that displaces
// the flesh, with the index of its bone, its `vertices`, the range of its coefficients (`lowest`, `highest`), and
// `drivers` and `modes`, a row per mode. Modes are whole multiples of unit_m. pbs/skinning/correctives.hpp explains
// these numbers.
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/deformers/deformer.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/correctives.hpp"

#include <string>

namespace experiments {

struct CorrectivesOptions {
    std::string file = {}, file_hash = {};  // its path, and the hash of its bytes when the scene was read
    pbs::Precision precision = pbs::Precision::f32;
};

// It rounds the modes to multiples of unit_m.
std::string text_of(const pbs::Correctives& correctives, const pbs::Character& character);

// InputError by line: no TOML; a key that is unknown, missing or of another type or size; a number that is not finite;
// bones, tets or weights other than those of the character; an index that is out of range; and contents that have been
// changed.
pbs::Correctives parse_correctives(const std::string& text, const std::string& file, const pbs::Character& character);

// The program comes with correctives of five bodies, which the study `references` learns. They fit the tets of the kept
// references and the skinning weights of the kind `diffused`.
std::string file_of_correctives(const std::string& body);
DeformerSpec kept_correctives(const std::string& body);  // InputError without such a file

}  // namespace experiments
