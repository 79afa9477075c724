#include "reference_fem/held_parts.hpp"

#include "reference_fem/input_checks.hpp"

#include <Eigen/Eigenvalues>

#include <map>
#include <numeric>
#include <set>

namespace reference_fem {
namespace {

// Root of each vertex's connected part (union-find).
std::vector<int> part_of_vertices(const pbs::TetMesh& mesh)
{
    std::vector<int> parent(mesh.rest.rows());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int vertex) {
        while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
        return vertex;
    };
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 1; corner < 4; ++corner) parent[root(mesh.tets(t, corner))] = root(mesh.tets(t, 0));
    for (std::size_t v = 0; v < parent.size(); ++v) parent[v] = root(static_cast<int>(v));
    return parent;
}

// The second largest spread of the points, relative to the largest, is not lost in rounding.
bool span_a_plane(const std::vector<pbs::Vec3>& points)
{
    if (points.size() < 3) return false;
    pbs::Vec3 mean = pbs::Vec3::Zero();
    for (const pbs::Vec3& point : points) mean += point / static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const pbs::Vec3& point : points) scatter += (point - mean) * (point - mean).transpose();
    const pbs::Vec3 spread = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
    return spread(1) > 1e-12 * spread(2);
}

}  // namespace

void require_held(const pbs::TetMesh& mesh, const pbs::Positions& points, const std::vector<int>& tets)
{
    const std::vector<int> part = part_of_vertices(mesh);
    std::map<int, std::vector<pbs::Vec3>> held;
    for (Eigen::Index p = 0; p < points.rows(); ++p)
        if (tets[p] >= 0) held[part[mesh.tets(tets[p], 0)]].push_back(points.row(p));
    std::set<int> checked;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const int of_tet = part[mesh.tets(t, 0)];
        if (!checked.insert(of_tet).second) continue;
        require(span_a_plane(held[of_tet]), "attachment of the part with tet", t,
                "expected three held points inside that are not on one line");
    }
}

}  // namespace reference_fem
