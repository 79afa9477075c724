// Replaces the readers and writers in a build without them.
#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/input_error.hpp"

namespace pbs {
namespace {

[[noreturn]] void refuse(const std::string& path)
{
    throw InputError(path, 0, "", "", "this build reads and writes no mesh files: configure it with -DPBS_WITH_MESH_IO=ON");
}

}  // namespace

MeshReading read_tet_mesh(const std::string& path)
{
    refuse(path);
}
TetMesh read_tet_frame(const std::string& path)
{
    refuse(path);
}
void require_tet_mesh_format(const std::string& path)
{
    refuse(path);
}
void write_tet_mesh(const std::string& path, const TetMesh&)
{
    refuse(path);
}
SurfaceMesh read_surface(const std::string& path, std::vector<std::string>&, double)
{
    refuse(path);
}
SurfaceMesh read_surface(const std::string& path, const std::string&)
{
    refuse(path);
}
void write_vtu(const std::string& path, const Positions&, const Tets&, const FrameFields&)
{
    refuse(path);
}
void write_vtp(const std::string& path, const Positions&, const Triangles&)
{
    refuse(path);
}
void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>&)
{
    refuse(path);
}

}  // namespace pbs
