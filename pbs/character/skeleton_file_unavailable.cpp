#include "pbs/character/skeleton_file.hpp"
#include "pbs/geometry/input_error.hpp"

namespace pbs {

Skeleton parse_skeleton(const std::string&, const std::string& name)
{
    throw InputError(name, 0, "", "", "skeleton files are left out of this build (PBS_WITH_RIG_IMPORT is off)");
}

Skeleton read_skeleton(const std::string& path)
{
    return parse_skeleton({}, path);
}

}  // namespace pbs
