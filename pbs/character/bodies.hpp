// Characters by name (built in: limb, bar, ring; installed: human, and man, lady, frankie by `pbskin fetch`) and from files.
#pragma once

#include "pbs/character/character.hpp"

namespace pbs {

struct CharacterSource {
    std::string body = {};  // limb, bar, ring, human, man, lady, frankie; empty: from files
    std::string mesh_file = {}, skeleton_file = {};
    double skeleton_scale = 1.0;  // metres a unit of the skeleton file
    int vertices = 0;             // wanted size of a body; 0: its default (limb 1,775, bar 1,800, others in Table 1's neighbourhood)
    WeightKind weights = WeightKind::paper;
    std::string weights_file = {};  // CSV vertex,joint,weight; empty: `weights`
    bool surface = true;            // carry the rendered surface along, where the body has one
    int refinements = 0;            // every tet into eight so many times; `vertices` and a weights file are of the unrefined mesh
};

// Are the files of a named body there? Cheap: nothing is read or meshed. require_body: an InputError that names what is missing.
void require_body(const std::string& body);
bool body_is_installed(const std::string& body);

// Builds it, or takes the tets from the cache (content hash of what they are made from). A body that is not installed is an InputError
// that names its package.
Character make_character(const CharacterSource& source);

}  // namespace pbs
