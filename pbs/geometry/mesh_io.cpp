#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_checks.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"

namespace pbs {
namespace {

TetMesh read_by_extension(const std::string& path)
{
    const std::string extension = lower_extension(path);
    const bool vtk = extension == ".vtu" || extension == ".vtk";
    const bool gmsh = extension == ".msh" || extension == ".mesh";
    const bool tetgen = extension == ".node" || extension == ".ele";
    if (!vtk && !gmsh && !tetgen)
        throw InputError(path, 0, "extension", extension, "expected a tet mesh: .msh, .vtu, .vtk, .mesh, .node or .ele");
    require_readable(path, vtk ? most_mesh_bytes : most_text_bytes);
    if (tetgen) return read_tetgen(path);
    const long long named = gmsh ? check_gmsh_file(path) : -1;
    const IndexedPoints read = read_guarded(path, vtk ? read_vtk : read_gmsh);
    if (read.cells.rows() > 0 && named >= 0 && named != read.points.rows())  // it leaves out vertices that no element uses
        throw InputError(path, 0, "vertices", std::to_string(named),
                         "expected all in elements; Gmsh reads " + std::to_string(read.points.rows()));
    return {read.points, read.cells};
}

}  // namespace

TetMesh read_tet_frame(const std::string& path)
{
    TetMesh mesh = read_by_extension(path);
    check_frame(path, mesh);
    return mesh;
}

MeshReading read_tet_mesh(const std::string& path)
{
    return check_rest(path, read_by_extension(path));
}

void require_tet_mesh_format(const std::string& path)
{
    const std::string extension = lower_extension(path);
    if (extension != ".msh" && extension != ".vtu" && extension != ".mesh")
        throw InputError(path, 0, "extension", extension, "expected .msh, .vtu or .mesh");
}

void write_tet_mesh(const std::string& path, const TetMesh& mesh)
{
    require_tet_mesh_format(path);
    const std::string extension = lower_extension(path);
    if (extension == ".msh") return write_msh(path, mesh);
    if (extension == ".mesh") return write_medit(path, mesh);
    write_vtu(path, mesh.rest, mesh.tets, {});
}

}  // namespace pbs
