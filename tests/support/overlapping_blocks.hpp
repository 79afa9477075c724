// Two blocks, far from each other at rest, of which the smaller one has been pushed into the other one.
#pragma once

#include "tests/support/structured_bar.hpp"

#include <numeric>

namespace test_support {

struct OverlappingBlocks {
    pbs::TetMesh mesh;
    int vertices_of_first = 0;
    pbs::Positions pushed;  // [m], #V x 3
};

// A cube of 1 m with its top at z = 0 and a block of 0.5 m, whose bottom is pushed `depth_m` below that top.
inline OverlappingBlocks overlapping_blocks(double depth_m)
{
    const pbs::TetMesh first = structured_bar({-0.5, -0.5, -1}, {0.5, 0.5, 0}, {4, 4, 4});
    const pbs::TetMesh second = structured_bar({-0.23, -0.27, 2}, {0.27, 0.23, 2.5}, {2, 2, 2});
    OverlappingBlocks blocks;
    blocks.vertices_of_first = static_cast<int>(first.rest.rows());
    blocks.mesh.rest.resize(first.rest.rows() + second.rest.rows(), 3);
    blocks.mesh.rest << first.rest, second.rest;
    blocks.mesh.tets.resize(first.tets.rows() + second.tets.rows(), 4);
    blocks.mesh.tets << first.tets, second.tets.array() + blocks.vertices_of_first;
    blocks.pushed = blocks.mesh.rest;
    blocks.pushed.bottomRows(second.rest.rows()).col(2).array() -= 2.0 + depth_m;
    return blocks;
}

inline std::vector<int> in_order(Eigen::Index count)
{
    std::vector<int> places(count);
    std::iota(places.begin(), places.end(), 0);
    return places;
}

}  // namespace test_support
