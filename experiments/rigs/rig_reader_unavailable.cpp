#include "experiments/rigs/glb_writer.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "pbs/geometry/input_error.hpp"

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

RigMaterials read_materials(const std::string&)
{
    return {};
}

GlbWriter::GlbWriter(std::string path, std::string name, const Triangles&, RigLook, RigMaterials)
    : path_(std::move(path)), name_(std::move(name)), data_(path_)
{
    throw InputError(path_, 0, "", "", "glTF is left out of this build (PBS_WITH_RIG_IMPORT is off)");
}

void GlbWriter::add_frame(double, const Positions&)
{
}

double GlbWriter::bytes(int) const
{
    return 0.0;
}

void GlbWriter::write()
{
}

}  // namespace pbs
