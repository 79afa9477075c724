#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/glb_writer.hpp"
#include "pbs/rig/rig_reader.hpp"

namespace pbs {

bool is_rig_file(const std::string&)
{
    return false;
}

bool rig_has_skin(const std::string&)
{
    return false;
}

Rig read_rig(const std::string& path)
{
    throw InputError(path, 0, "", "", "rigs are left out of this build (PBS_WITH_RIG_IMPORT is off)");
}

void write_glb(const std::string& path, const std::string&, const Triangles&, const std::vector<double>&, const std::vector<Positions>&)
{
    throw InputError(path, 0, "", "", "glTF is left out of this build (PBS_WITH_RIG_IMPORT is off)");
}

}  // namespace pbs
