// Replaces the meshing in a build without it.
#include "pbs/geometry/meshing.hpp"

#include "pbs/geometry/input_error.hpp"

namespace pbs {
namespace {

[[noreturn]] void refuse(const char* what)
{
    throw InputError("", 0, what, "", "this build meshes no bodies: configure it with -DPBS_WITH_CGAL=ON");
}

}  // namespace

TetMesh mesh_limb(int)
{
    refuse("limb");
}
TetMesh mesh_bar(int)
{
    refuse("bar");
}
TetMesh mesh_surface(const SurfaceMesh&, const SurfaceMeshing&)
{
    refuse("surface");
}
double sheet_offset_m(const SurfaceMesh&)
{
    refuse("surface");
}
bool self_intersects(const Positions&, const Triangles&)
{
    refuse("self-intersection");
}
std::vector<std::array<int, 2>> self_intersections(const Positions&, const Triangles&)
{
    refuse("self-intersection");
}
int count_self_intersections(const Positions&, const Triangles&)
{
    refuse("self-intersection");
}
std::vector<std::vector<Positions>> section_outlines(const Positions&, const Triangles&, const std::vector<CuttingPlane>&)
{
    refuse("cross-sections");
}
std::vector<bool> points_inside(const Positions&, const Triangles&, const std::vector<Vec3>&)
{
    refuse("points inside");
}
std::vector<int> vertices_inside_other_tets(const Positions&, const Tets&, const std::vector<int>&)
{
    refuse("vertices inside other tets");
}

}  // namespace pbs
