// Frankie, nearest to the paper's bunny (Table 1): the flying squirrel of the game Yo Frankie! by the Apricot project, as Debian's
// cube2-data has him (CC-BY 3.0; name John 'geartrooper' Siar, Gregor Koch and the Apricot project wherever he is shown). His skin is open
// and in eleven pieces; its wrap is what is meshed, and as it encloses no volume it is not carried along.
#pragma once

#include "pbs/character/character.hpp"

#include <string>

namespace pbs {

std::string frankie_file();  // where cube2-data puts him

void require_frankie();  // an InputError where he is not installed

// His size as in the file: 0.58 m. vertices 0: as in Table 1, 2,108.
Character make_frankie(int vertices);

}  // namespace pbs
