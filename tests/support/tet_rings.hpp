// Tets around one edge, and renumbered meshes: the topologies that fans, slabs and batches must handle.
//   const pbs::Tets closed = tet_ring(5, true);   // five tets round the edge 0, 1, closed
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <vector>

namespace test_support {

// `count` tets of one orientation around the edge 0, 1; ring vertices 2, 3 ... count + 1, and one more if the ring is
// open.
inline pbs::Tets tet_ring(int count, bool closed)
{
    pbs::Tets tets(count, 4);
    for (int t = 0; t < count; ++t) tets.row(t) << 0, 1, 2 + t, 2 + (closed ? (t + 1) % count : t + 1);
    return tets;
}

inline std::vector<std::array<int, 4>> rows_of(const pbs::Tets& tets)
{
    std::vector<std::array<int, 4>> rows;
    for (const auto tet : tets.rowwise()) rows.push_back({tet(0), tet(1), tet(2), tet(3)});
    return rows;
}

inline std::vector<std::array<int, 2>> rows_of(const pbs::Edges& edges)
{
    std::vector<std::array<int, 2>> rows;
    for (const auto edge : edges.rowwise()) rows.push_back({edge(0), edge(1)});
    return rows;
}

// The same mesh with randomly renumbered vertices and tets, and each tet's corners permuted at random without a change
// of orientation.
inline pbs::Tets shuffled(const pbs::Tets& tets, int vertices, unsigned seed)
{
    std::mt19937 engine(seed);
    std::vector<int> vertex(vertices), row(tets.rows());
    std::iota(vertex.begin(), vertex.end(), 0);
    std::iota(row.begin(), row.end(), 0);
    std::shuffle(vertex.begin(), vertex.end(), engine);
    std::shuffle(row.begin(), row.end(), engine);
    pbs::Tets result(tets.rows(), 4);
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
        for (int corner = 0; corner < 4; ++corner) result(t, corner) = vertex[tets(row[t], corner)];
        // rotates three corners: an even permutation
        for (int turns = static_cast<int>(engine() % 3); turns > 0; --turns) {
            std::swap(result(t, 0), result(t, 1));
            std::swap(result(t, 1), result(t, 2));
        }
    }
    return result;
}

// Two meshes side by side; the vertices of the second are numbered after those of the first.
inline pbs::Tets beside(const pbs::Tets& first, int vertices_of_first, const pbs::Tets& second)
{
    pbs::Tets both(first.rows() + second.rows(), 4);
    both << first, (second.array() + vertices_of_first).matrix();
    return both;
}

}  // namespace test_support
