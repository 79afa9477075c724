// The reader of clips in a build without PBS_WITH_RIG_IMPORT.
#include "experiments/clips/clip.hpp"
#include "pbs/geometry/input_error.hpp"

namespace pbs {

Clip read_clip(const std::string& path, const std::string&)
{
    throw InputError(path, 0, "", "", "clips are left out of this build (PBS_WITH_RIG_IMPORT is off)");
}

}  // namespace pbs
