#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"

namespace pbs {
namespace {

enum class TetFormat { vtk, gmsh, tetgen, tobj };

// By what the file holds; files of TetGen and HOBAK, which begin with plain numbers or vertices, by their extension.
TetFormat format_of(const std::string& path)
{
    const std::string beginning = beginning_of(path), extension = lower_extension(path);
    const auto holds = [&](const char* text) { return beginning.find(text) != std::string::npos; };
    if (holds("# vtk DataFile") || holds("<VTKFile")) return TetFormat::vtk;
    const std::string format = format_extension(path);
    if (format == ".msh" || format == ".mesh") return TetFormat::gmsh;
    if (extension == ".vtu" || extension == ".vtk") return TetFormat::vtk;
    if (extension == ".node" || extension == ".ele") return TetFormat::tetgen;
    if (extension == ".tobj") return TetFormat::tobj;
    throw InputError(path, 0, "extension", extension, "expected a tet mesh: .msh, .vtu, .vtk, .mesh, .tobj, .node or .ele");
}

// Gmsh chooses its own reader by the extension.
TetMesh read_by_gmsh(const std::string& path)
{
    const long long named = check_gmsh_file(path);
    const NamedLink link(path, format_extension(path));
    TetMesh read = read_guarded(path, [&](const std::string& file) { return read_gmsh(file, link.path()); });
    if (read.tets.rows() > 0 && named >= 0 && named != read.rest.rows())  // it leaves out vertices that no element uses
        throw InputError(path, 0, "vertices", std::to_string(named),
                         "expected all in elements; Gmsh reads " + std::to_string(read.rest.rows()));
    return read;
}

TetMesh read_by_content(const std::string& path)
{
    const TetFormat format = format_of(path);
    require_readable(path, format == TetFormat::vtk ? most_mesh_bytes : most_text_bytes);
    if (format == TetFormat::tetgen) return read_tetgen(path);
    if (format == TetFormat::tobj) return read_tobj(path);
    if (format == TetFormat::vtk) return read_guarded(path, read_vtk);
    return read_by_gmsh(path);
}

}  // namespace

TetMesh read_tet_frame(const std::string& path)
{
    TetMesh mesh = read_by_content(path);
    check_frame(path, mesh);
    return mesh;
}

MeshReading read_tet_mesh(const std::string& path, bool separates)
{
    MeshReading reading = check_rest(path, read_by_content(path), separates);
    if (format_of(path) == TetFormat::gmsh && format_extension(path) != lower_extension(path)) reading.read_as = format_extension(path);
    return reading;
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
