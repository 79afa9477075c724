// The skin weights of a COLLADA file as the file states them: assimp leaves out weights that are negative or not finite without a message.
//   check_collada_weights("hero.dae");
#pragma once

#include <string>

namespace pbs {

// .dae, or a .zae archive with .dae files. An InputError names the first weight, of a skin that the scene uses, that is negative or not
// finite. Text that is not XML is left to the reader.
void check_collada_weights(const std::string& path);

}  // namespace pbs
