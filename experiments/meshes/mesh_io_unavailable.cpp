// Replaces the readers and writers in a build without them.
#include "experiments/meshes/mesh_io_formats.hpp"
#include "pbs/geometry/input_error.hpp"

#define PBS_REFUSE(...)                                                                                         \
    __VA_ARGS__                                                                                                 \
    {                                                                                                           \
        throw InputError(path, 0, "", "",                                                                       \
                         "this build reads and writes no mesh files: configure it with -DPBS_WITH_MESH_IO=ON"); \
    }

namespace pbs {

PBS_REFUSE(MeshReading read_tet_mesh(const std::string& path, bool))
PBS_REFUSE(TetMesh read_tet_frame(const std::string& path))
PBS_REFUSE(void require_tet_mesh_format(const std::string& path))
PBS_REFUSE(void write_tet_mesh(const std::string& path, const TetMesh&))
PBS_REFUSE(SurfaceMesh read_obj(const std::string& path, const std::string&))
PBS_REFUSE(SurfaceMesh read_polygons(const std::string& path))
PBS_REFUSE(SurfaceMesh read_vtp(const std::string& path))
PBS_REFUSE(std::map<std::string, Eigen::MatrixXd> read_point_arrays(const std::string& path, const std::string&))
PBS_REFUSE(void write_vtu(const std::string& path, const Positions&, const Tets&, const FrameFields&))
PBS_REFUSE(void write_vtp(const std::string& path, const Positions&, const Triangles&))
PBS_REFUSE(std::vector<std::string> read_pvd(const std::string& path))
PBS_REFUSE(void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>&))

}  // namespace pbs
