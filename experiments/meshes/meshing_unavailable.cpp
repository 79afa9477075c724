// Replaces the meshing in a build without it.
#include "experiments/meshes/meshing.hpp"

#include "pbs/geometry/input_error.hpp"

#define PBS_REFUSE(what, ...)                                                                                   \
    __VA_ARGS__                                                                                                 \
    {                                                                                                           \
        throw InputError("", 0, what, "", "this build meshes no bodies: configure it with -DPBS_WITH_CGAL=ON"); \
    }

namespace pbs {

PBS_REFUSE("limb", TetMesh mesh_limb(int))
PBS_REFUSE("bar", TetMesh mesh_bar(int))
PBS_REFUSE("surface", TetMesh mesh_surface(const SurfaceMesh&, const SurfaceMeshing&))
PBS_REFUSE("tets", TetMesh mesh_anew(const TetMesh&, const Remeshing&))
PBS_REFUSE("surface", double sheet_offset_m(const SurfaceMesh&))
PBS_REFUSE("self-intersection", bool self_intersects(const Positions&, const Triangles&))
PBS_REFUSE("self-intersection", std::vector<std::array<int, 2>> self_intersections(const Positions&, const Triangles&))
PBS_REFUSE("self-intersection", int count_self_intersections(const Positions&, const Triangles&))
PBS_REFUSE("cross-sections", std::vector<std::vector<Positions>> section_outlines(const Positions&, const Triangles&,
                                                                                  const std::vector<CuttingPlane>&))
PBS_REFUSE("points inside",
           std::vector<bool> points_inside(const Positions&, const Triangles&, const std::vector<Vec3>&))

}  // namespace pbs
