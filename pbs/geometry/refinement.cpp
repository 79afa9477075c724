#include "pbs/geometry/refinement.hpp"

#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>

namespace pbs {
namespace {

using Nodes = std::array<int, 10>;  // of a tet: its corners, then the midpoints of 01, 02, 03, 12, 13, 23
constexpr std::array<std::array<int, 2>, 6> edge_corners = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// The children in nodes of their parent, positively oriented.
using Children = std::array<std::array<int, 4>, 4>;
constexpr Children at_corners = {{{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}}};

// The octahedron's diagonals, and its four tets round each of them.
struct Diagonal {
    int from, to;
    Children tets;
};
constexpr std::array<Diagonal, 3> diagonals = {{{4, 9, {{{4, 9, 7, 5}, {4, 9, 8, 7}, {4, 9, 6, 8}, {4, 9, 5, 6}}}},
                                                {5, 8, {{{5, 8, 4, 7}, {5, 8, 7, 9}, {5, 8, 9, 6}, {5, 8, 6, 4}}}},
                                                {6, 7, {{{6, 7, 8, 4}, {6, 7, 9, 8}, {6, 7, 5, 9}, {6, 7, 4, 5}}}}}};

// Row of `edges`, which are sorted.
int index_of_edge(const Edges& edges, int a, int b)
{
    const std::array<int, 2> wanted = {std::min(a, b), std::max(a, b)};
    Eigen::Index first = 0, last = edges.rows();
    while (first < last) {
        const Eigen::Index middle = (first + last) / 2;
        if (std::array<int, 2>{edges(middle, 0), edges(middle, 1)} < wanted)
            first = middle + 1;
        else
            last = middle;
    }
    return static_cast<int>(first);
}

Nodes nodes_of(const TetMesh& mesh, const Edges& edges, Eigen::Index tet)
{
    Nodes nodes;
    for (int corner = 0; corner < 4; ++corner) nodes[corner] = mesh.tets(tet, corner);
    for (std::size_t e = 0; e < edge_corners.size(); ++e)
        nodes[4 + e] = static_cast<int>(mesh.rest.rows()) + index_of_edge(edges, nodes[edge_corners[e][0]], nodes[edge_corners[e][1]]);
    return nodes;
}

const Diagonal& shortest_diagonal(const Positions& rest, const Nodes& nodes)
{
    const auto squared_length = [&](const Diagonal& diagonal) {
        return (rest.row(nodes[diagonal.from]) - rest.row(nodes[diagonal.to])).squaredNorm();
    };
    return *std::min_element(diagonals.begin(), diagonals.end(),
                             [&](const Diagonal& a, const Diagonal& b) { return squared_length(a) < squared_length(b); });
}

}  // namespace

Refinement refine(const TetMesh& mesh)
{
    Refinement fine;
    fine.parents = edges_of(mesh.tets);
    fine.mesh.rest = prolongated(mesh.rest, fine.parents);
    fine.mesh.tets.resize(8 * mesh.tets.rows(), 4);
    Eigen::Index next = 0;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const Nodes nodes = nodes_of(mesh, fine.parents, t);
        for (const Children* children : {&at_corners, &shortest_diagonal(fine.mesh.rest, nodes).tets})
            for (const auto& [a, b, c, d] : *children) fine.mesh.tets.row(next++) << nodes[a], nodes[b], nodes[c], nodes[d];
    }
    return fine;
}

Positions prolongated(const Positions& coarse, const Edges& parents)
{
    Positions fine(coarse.rows() + parents.rows(), 3);
    fine.topRows(coarse.rows()) = coarse;
    for (Eigen::Index e = 0; e < parents.rows(); ++e)
        fine.row(coarse.rows() + e) = 0.5 * (coarse.row(parents(e, 0)) + coarse.row(parents(e, 1)));
    return fine;
}

}  // namespace pbs
