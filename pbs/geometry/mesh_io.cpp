#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_checks.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"

namespace pbs {
namespace {

enum class TetFormat { vtk, gmsh, tetgen, tobj };

// By what the file holds; TetGen's files, which begin with plain numbers, by their extension. Gmsh chooses its own reader by the extension.
TetFormat format_of(const std::string& path)
{
    const std::string beginning = beginning_of(path), extension = lower_extension(path);
    const auto holds = [&](const char* text) { return beginning.find(text) != std::string::npos; };
    const bool is_gmsh = extension == ".msh" || extension == ".mesh";
    if (holds("# vtk DataFile") || holds("<VTKFile")) return TetFormat::vtk;
    if (!is_gmsh && (holds("$MeshFormat") || holds("$NOD") || holds("MeshVersionFormatted")))
        throw InputError(
            path, 0, "extension", extension,
            holds("MeshVersionFormatted") ? "the file is a MEDIT mesh: rename it to .mesh" : "the file is a Gmsh mesh: rename it to .msh");
    if (extension == ".vtu" || extension == ".vtk") return TetFormat::vtk;
    if (is_gmsh) return TetFormat::gmsh;
    if (extension == ".node" || extension == ".ele") return TetFormat::tetgen;
    if (extension == ".tobj") return TetFormat::tobj;
    throw InputError(path, 0, "extension", extension, "expected a tet mesh: .msh, .vtu, .vtk, .mesh, .tobj, .node or .ele");
}

TetMesh read_by_content(const std::string& path)
{
    const TetFormat format = format_of(path);
    require_readable(path, format == TetFormat::vtk ? most_mesh_bytes : most_text_bytes);
    if (format == TetFormat::tetgen) return read_tetgen(path);
    if (format == TetFormat::tobj) return read_tobj(path);
    const bool is_gmsh = format == TetFormat::gmsh;
    const long long named = is_gmsh ? check_gmsh_file(path) : -1;
    const IndexedPoints read = read_guarded(path, is_gmsh ? read_gmsh : read_vtk);
    if (read.cells.rows() > 0 && named >= 0 && named != read.points.rows())  // it leaves out vertices that no element uses
        throw InputError(path, 0, "vertices", std::to_string(named),
                         "expected all in elements; Gmsh reads " + std::to_string(read.points.rows()));
    return {read.points, read.cells};
}

}  // namespace

TetMesh read_tet_frame(const std::string& path)
{
    TetMesh mesh = read_by_content(path);
    check_frame(path, mesh);
    return mesh;
}

MeshReading read_tet_mesh(const std::string& path)
{
    return check_rest(path, read_by_content(path));
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
