#include "reference_fem/options.hpp"

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace reference_fem {

void check_mesh(const pbs::TetMesh& mesh)
{
    require(mesh.tets.rows() > 0, "tets", mesh.tets.rows(), "expected at least one");
    require(mesh.rest.allFinite(), "rest positions", "not a number or infinite", "expected finite coordinates");
    std::vector<bool> used(mesh.rest.rows(), false);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        for (const int vertex : mesh.tets.row(t)) {
            require(vertex >= 0 && vertex < mesh.rest.rows(), "tet vertex", vertex, "expected an index below the number of vertices");
            used[vertex] = true;
        }
        const auto corner = [&](int c) -> pbs::Vec3 { return mesh.rest.row(mesh.tets(t, c)); };
        require(pbs::tet_volume(corner(0), corner(1), corner(2), corner(3)) > 0.0, "tet", t, "expected a positive volume");
    }
    for (std::size_t v = 0; v < used.size(); ++v) require(used[v], "vertex", v, "expected every vertex to belong to a tet");
}

}  // namespace reference_fem
