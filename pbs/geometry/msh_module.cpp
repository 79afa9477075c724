// The module pbskin_gmsh: reads .msh (2.2, 4.1, ASCII, binary) and MEDIT .mesh by Gmsh.
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"

#include <gmsh.h>

#include <unordered_map>
#include <vector>

namespace pbs {
namespace {

constexpr int tet_type = 4;  // Gmsh's element type of the four-node tetrahedron

// Gmsh between initialize and finalize: silent, no configuration files.
class GmshSession {
public:
    GmshSession()
    {
        gmsh::initialize(0, nullptr, false);
        gmsh::option::setNumber("General.Terminal", 0);
    }
    ~GmshSession() { gmsh::finalize(); }
    GmshSession(const GmshSession&) = delete;
    GmshSession& operator=(const GmshSession&) = delete;
};

void refuse_other_volumes(const std::string& path)
{
    std::vector<int> types;
    gmsh::model::mesh::getElementTypes(types, 3);
    for (const int type : types) {
        if (type == tet_type) continue;
        std::string name;
        int dimension = 0, order = 0, nodes = 0, primary = 0;
        std::vector<double> coordinates;
        gmsh::model::mesh::getElementProperties(type, name, dimension, order, nodes, coordinates, primary);
        throw InputError(path, 0, "elements", name, "expected four-node tetrahedra");
    }
}

IndexedPoints current_tets(const std::string& path)
{
    std::vector<std::size_t> node_tags, tet_tags, corners;
    std::vector<double> coordinates, parametric;
    gmsh::model::mesh::getNodes(node_tags, coordinates, parametric, -1, -1, false, false);
    gmsh::model::mesh::getElementsByType(tet_type, tet_tags, corners);

    IndexedPoints mesh;
    mesh.points = Eigen::Map<const Positions>(coordinates.data(), static_cast<Eigen::Index>(node_tags.size()), 3);
    mesh.cells.resize(static_cast<Eigen::Index>(tet_tags.size()), 4);
    std::unordered_map<std::size_t, int> index_of;
    for (std::size_t i = 0; i < node_tags.size(); ++i) index_of.emplace(node_tags[i], static_cast<int>(i));
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto found = index_of.find(corners[k]);
        if (found == index_of.end())
            throw InputError(path, 0, "element " + std::to_string(tet_tags[k / 4]), std::to_string(corners[k]),
                             "expected the tag of a node");
        mesh.cells(static_cast<Eigen::Index>(k / 4), static_cast<Eigen::Index>(k % 4)) = found->second;
    }
    return mesh;
}

}  // namespace
}  // namespace pbs

extern "C" void pbskin_gmsh_read(const std::string& path, pbs::IndexedPoints& mesh)
{
    const pbs::GmshSession session;
    try {
        gmsh::open(path);
        pbs::refuse_other_volumes(path);
        mesh = pbs::current_tets(path);
    } catch (const std::string& words) {
        throw pbs::InputError(path, 0, "", "", "Gmsh: " + words);
    }
}
