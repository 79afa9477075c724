// The body and the pose of every value of the bench: a twist of 90 degrees about the mesh's longest axis.
//   bar:  [-1, 1] x [-0.15, 0.15]^2 m     held o=======o=======o 90 degrees
#pragma once

#include "pbs/character/character.hpp"

#include <string>

namespace experiments {

struct BenchBody {
    pbs::Character character;    // two bones of equal length along the axis, Eq. 2's weights
    pbs::Positions twisted;      // turned by an angle that grows linearly along the axis [m], #V x 3
    pbs::Positions bind_points;  // on the axis, which does not move [m], #V x 3
    std::vector<bool> held;      // the first 2.5 % of the length, #V
    pbs::Pose pose;              // the second bone turned by 90 degrees
    int edges = 0;

    const pbs::TetMesh& mesh() const { return character.mesh; }
};

BenchBody make_bench_body(const std::string& name, pbs::TetMesh mesh);

// The built-in bar with about so many vertices, or tets. Beyond 150,000 tets it is the bar with an eighth of them, each cut into eight.
BenchBody bench_bar(int vertices);
BenchBody bench_bar_of_tets(int tets);

}  // namespace experiments
