// Tet meshes as text with 17 digits: Gmsh 4.1, with one entity (3, 1) that holds all tets, and MEDIT. Gmsh's own writer
// prints 16 digits
// (.msh) or 14 (.mesh), which do not read back to the bit.
// Formats: Gmsh reference manual 4.8, "MSH file format"; MEDIT, Frey, "MEDIT: an interactive mesh visualization
// software" (INRIA, 2001).

#include "experiments/meshes/mesh_io_formats.hpp"
#include "pbs/system/files.hpp"

#include <functional>
#include <locale>
#include <sstream>
#include <string>

namespace pbs {
namespace {

// 17 significant digits name a double exactly. Whatever the locale of the program that uses this library.
void write_text(const std::string& path, const std::function<void(std::ostringstream&)>& write)
{
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(17);
    write(text);
    write_atomically(path, text.str());
}

void write_point(std::ostringstream& file, const Positions& points, Eigen::Index i)
{
    file << points(i, 0) << ' ' << points(i, 1) << ' ' << points(i, 2);
}

void write_corners(std::ostringstream& file, const Tets& tets, Eigen::Index t)
{
    for (int corner = 0; corner < 4; ++corner) file << tets(t, corner) + 1 << ' ';
}

void write_msh_entities(std::ostringstream& file, const Positions& points)
{
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    if (points.rows() > 0) {
        low = points.colwise().minCoeff().transpose();
        high = points.colwise().maxCoeff().transpose();
    }
    file << "$Entities\n0 0 0 1\n1 " << low.transpose() << ' ' << high.transpose() << " 0 0\n$EndEntities\n";
}

}  // namespace

void write_msh(const std::string& path, const TetMesh& mesh)
{
    write_text(path, [&](std::ostringstream& file) {
        const Eigen::Index points = mesh.rest.rows(), tets = mesh.tets.rows();
        file << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
        write_msh_entities(file, mesh.rest);
        file << "$Nodes\n1 " << points << " 1 " << points << "\n3 1 0 " << points << '\n';
        for (Eigen::Index i = 0; i < points; ++i) file << i + 1 << '\n';
        for (Eigen::Index i = 0; i < points; ++i) {
            write_point(file, mesh.rest, i);
            file << '\n';
        }
        file << "$EndNodes\n$Elements\n1 " << tets << " 1 " << tets << "\n3 1 4 " << tets << '\n';
        for (Eigen::Index t = 0; t < tets; ++t) {
            file << t + 1 << ' ';
            write_corners(file, mesh.tets, t);
            file << '\n';
        }
        file << "$EndElements\n";
    });
}

void write_medit(const std::string& path, const TetMesh& mesh)
{
    write_text(path, [&](std::ostringstream& file) {
        file << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << mesh.rest.rows() << '\n';
        for (Eigen::Index i = 0; i < mesh.rest.rows(); ++i) {
            write_point(file, mesh.rest, i);
            file << " 1\n";
        }
        file << "Tetrahedra\n" << mesh.tets.rows() << '\n';
        for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
            write_corners(file, mesh.tets, t);
            file << "1\n";
        }
        file << "End\n";
    });
}

}  // namespace pbs
