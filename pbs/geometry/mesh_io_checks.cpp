#include "pbs/geometry/mesh_io_checks.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"
#include "pbs/geometry/mesh_repair.hpp"
#include "pbs/geometry/meshing.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

namespace pbs {
namespace {

// |V| / (longest edge)^3 is 0.118 for the regular tet. Rounding of the coordinates alone leaves some 1e-16 D / l of it, D the distance
// from the origin: 1e-10 keeps clear of that for every mesh with D / l < 1e5.
constexpr double flat_tet = 1e-10;
constexpr double farthest_m = 1e9;  // beyond, products of three lengths leave the range of a double

std::string numbered(const char* what, Eigen::Index i)
{
    return what + std::string(" ") + std::to_string(i);
}

template <typename Row>
std::string listed(const Row& row)
{
    std::ostringstream text;
    text.precision(17);
    text << '(';
    for (Eigen::Index i = 0; i < row.size(); ++i) text << (i ? ", " : "") << row(i);
    return text.str() + ')';
}

double longest_edge(const TetMesh& mesh, Eigen::Index t)
{
    double longest = 0.0;
    for (int a = 0; a < 4; ++a)
        for (int b = a + 1; b < 4; ++b)
            longest = std::max(longest, (mesh.rest.row(mesh.tets(t, a)) - mesh.rest.row(mesh.tets(t, b))).norm());
    return longest;
}

int normalise_orientation(const std::string& path, TetMesh& mesh)
{
    int flipped = 0;
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const double length = longest_edge(mesh, t);
        if (!(std::abs(volumes(t)) > flat_tet * length * length * length))
            throw InputError(path, 0, numbered("tet", t), listed(mesh.tets.row(t)),
                             "expected a volume; its four vertices are in one plane");
        if (volumes(t) > 0.0) continue;
        std::swap(mesh.tets(t, 2), mesh.tets(t, 3));
        ++flipped;
    }
    return flipped;
}

// Vertices of the file, of which an unused one may be anywhere.
void check_distinct(const std::string& path, const MeshReading& reading)
{
    const Positions& points = reading.mesh.rest;
    std::vector<Eigen::Index> order(static_cast<std::size_t>(points.rows()));
    std::iota(order.begin(), order.end(), Eigen::Index(0));
    const auto key = [&](Eigen::Index i) { return std::array{points(i, 0), points(i, 1), points(i, 2)}; };
    std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    for (std::size_t i = 1; i < order.size(); ++i) {
        const int vertex = reading.file_vertex[static_cast<std::size_t>(order[i])];
        const int before = reading.file_vertex[static_cast<std::size_t>(order[i - 1])];
        if (vertex != before && key(order[i - 1]) == key(order[i]))
            throw InputError(path, 0, numbered("vertex", vertex), listed(points.row(order[i])),
                             "expected a point of its own; " + numbered("vertex", before) + " is there already: merge the two");
    }
}

struct Face {
    std::array<int, 3> vertices;  // ascending
    bool even = false;            // ascending order is an even permutation of the outward order
    Eigen::Index tet = 0;
};

std::vector<Face> sorted_faces(const Tets& tets)
{
    std::vector<Face> faces;
    faces.reserve(static_cast<std::size_t>(4 * tets.rows()));
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int left_out = 0; left_out < 4; ++left_out) {
            std::array<int, 3> v = {tets(t, (left_out + 1) % 4), tets(t, (left_out + 2) % 4), tets(t, (left_out + 3) % 4)};
            bool even = left_out % 2 == 0;
            for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)})
                if (v[std::size_t(a)] > v[std::size_t(b)]) {
                    std::swap(v[std::size_t(a)], v[std::size_t(b)]);
                    even = !even;
                }
            faces.push_back({v, even, t});
        }
    std::sort(faces.begin(), faces.end(),
              [](const Face& a, const Face& b) { return std::pair(a.vertices, a.tet) < std::pair(b.vertices, b.tet); });
    return faces;
}

void check_places(const std::string& path, const Positions& points)
{
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        if (!points.row(i).allFinite())
            throw InputError(path, 0, numbered("vertex", i), listed(points.row(i)), "expected finite coordinates [m]");
        if (!(points.row(i).cwiseAbs().maxCoeff() <= farthest_m))
            throw InputError(path, 0, numbered("vertex", i), listed(points.row(i)), "expected within 1e9 m of the origin");
    }
}

// Two tets that share a face lie on either side of it; both positively oriented, they list it in opposite order.
void check_faces(const std::string& path, const TetMesh& mesh)
{
    const std::vector<Face> faces = sorted_faces(mesh.tets);
    for (std::size_t i = 1; i < faces.size(); ++i) {
        const Face &face = faces[i], &before = faces[i - 1];
        if (face.vertices != before.vertices) continue;
        if (face.even == before.even)
            throw InputError(path, 0, numbered("tet", face.tet), listed(mesh.tets.row(face.tet)),
                             "expected to lie beside " + numbered("tet", before.tet) + ", with which it shares a face; they overlap");
        if (i >= 2 && face.vertices == faces[i - 2].vertices)
            throw InputError(path, 0, numbered("tet", face.tet), listed(mesh.tets.row(face.tet)),
                             "expected faces of at most two tets; one face is in three");
    }
}

// Parts that touch in a vertex of the file are split there, so that their triangles share a place but no vertex.
void check_boundary(const std::string& path, const MeshReading& reading)
{
    if (!topology_of(reading.mesh.tets, reading.mesh.rest.rows()).boundary_manifold) {
        const auto edge = edge_that_is_not_manifold(reading.mesh.tets);
        const std::string where =
            edge ? "vertices " + std::to_string(reading.file_vertex[(*edge)[0]]) + " and " + std::to_string(reading.file_vertex[(*edge)[1]])
                 : "";
        throw InputError(
            path, 0, "boundary", where,
            "expected a manifold; tets that share no face touch in the edge of these vertices: join them by a face or give them "
            "vertices of their own");
    }
#ifdef PBS_WITH_CGAL
    const Triangles boundary = boundary_of(reading.mesh.tets);
    for (const auto& [a, b] : self_intersections(reading.mesh.rest, boundary)) {
        bool were_split = false;
        for (const int of_a : boundary.row(a))
            for (const int of_b : boundary.row(b))
                were_split = were_split || (of_a != of_b && reading.file_vertex[of_a] == reading.file_vertex[of_b]);
        if (were_split) continue;
        throw InputError(path, 0, "boundary", "vertex " + std::to_string(reading.file_vertex[boundary(a, 0)]),
                         "expected a surface that does not intersect itself; it does near this vertex: mesh the body anew (pbskin mesh)");
    }
#endif
}

}  // namespace

void check_frame(const std::string& path, const TetMesh& mesh)
{
    if (mesh.tets.rows() == 0) throw InputError(path, 0, "tets", "0", "expected at least one tetrahedron");
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) checked_index(path, t, mesh.tets(t, corner), mesh.rest.rows());
    check_places(path, mesh.rest);
}

MeshReading check_rest(const std::string& path, TetMesh mesh)
{
    check_frame(path, mesh);
    require_extent(path, mesh.rest);
    MeshReading reading;
    reading.flipped_tets = normalise_orientation(path, mesh);
    reading.file_vertices = static_cast<int>(mesh.rest.rows());
    check_faces(path, mesh);
    RepairedMesh repair = repaired(mesh);
    reading.mesh = std::move(repair.mesh);
    reading.file_vertex = std::move(repair.file_vertex);
    reading.unused_vertices = std::move(repair.unused);
    reading.split_vertices = std::move(repair.split);
    check_distinct(path, reading);
    check_boundary(path, reading);
    return reading;
}

}  // namespace pbs
