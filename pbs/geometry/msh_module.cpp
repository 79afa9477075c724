// The module pbskin_gmsh: reads .msh (1, 2.2, 4.1, ASCII, binary) and MEDIT .mesh by Gmsh.
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"

#include <gmsh.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <vector>

namespace pbs {
namespace {

constexpr int tet_type = 4;  // Gmsh's element type of the four-node tetrahedron

// From the first step until its end Gmsh is silent, and reads no configuration files.
struct GmshSession {
    ~GmshSession() { gmsh::finalize(); }
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

// Indices that put the tags in ascending order: Gmsh lists nodes and elements by entity, the file's numbers are what frames share.
std::vector<std::size_t> order_of(const std::vector<std::size_t>& tags)
{
    std::vector<std::size_t> order(tags.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
    return order;
}

// tags: of the points, ascending.
TetMesh current_tets(const std::string& path, std::vector<std::size_t>& tags)
{
    std::vector<std::size_t> node_tags, tet_tags, corners;
    std::vector<double> coordinates, parametric;
    gmsh::model::mesh::getNodes(node_tags, coordinates, parametric, -1, -1, false, false);
    gmsh::model::mesh::getElementsByType(tet_type, tet_tags, corners);

    TetMesh mesh;
    mesh.rest.resize(static_cast<Eigen::Index>(node_tags.size()), 3);
    std::unordered_map<std::size_t, int> index_of;
    for (const std::size_t from : order_of(node_tags)) {
        const int to = static_cast<int>(index_of.size());
        if (!index_of.emplace(node_tags[from], to).second)
            throw InputError(path, 0, "node", std::to_string(node_tags[from]), "expected each tag once");
        tags.push_back(node_tags[from]);
        mesh.rest.row(to) << coordinates[3 * from], coordinates[3 * from + 1], coordinates[3 * from + 2];
    }
    mesh.tets.resize(static_cast<Eigen::Index>(tet_tags.size()), 4);
    Eigen::Index to = 0;
    for (const std::size_t from : order_of(tet_tags)) {
        for (std::size_t k = 0; k < 4; ++k) {
            const auto found = index_of.find(corners[4 * from + k]);
            if (found == index_of.end())
                throw InputError(path, 0, "element " + std::to_string(tet_tags[from]), std::to_string(corners[4 * from + k]),
                                 "expected the tag of a node");
            mesh.tets(to, static_cast<Eigen::Index>(k)) = found->second;
        }
        ++to;
    }
    return mesh;
}

}  // namespace
}  // namespace pbs

// named: what Gmsh opens; path: what errors name.
extern "C" void pbskin_gmsh_read(const std::string& path, const std::string& named, pbs::TetMesh& mesh, std::vector<std::size_t>& tags)
{
    gmsh::initialize(0, nullptr, false);
    const pbs::GmshSession session;
    gmsh::option::setNumber("General.Terminal", 0);
    try {
        gmsh::open(named);
        pbs::refuse_other_volumes(path);
        mesh = pbs::current_tets(path, tags);
    } catch (const pbs::InputError&) {
        throw;
    } catch (const std::string& words) {  // Gmsh 4.8 throws its message
        throw pbs::InputError(path, 0, "", "", "Gmsh: " + words);
    } catch (const std::runtime_error& error) {  // Gmsh 4.13 throws a runtime_error
        throw pbs::InputError(path, 0, "", "", std::string("Gmsh: ") + error.what());
    }
}
