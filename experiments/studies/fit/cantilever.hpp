// A bar held at one end, the same tets and the same held vertices for the position based solver and for the finite elements: what k is
// given a unit on.
//
//   ####------------------------+     whole tets in the first tenth of the bar are held,
//   ####      bar, along x      | tip  all else is free
//   ####------------------------+
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "pbs/character/character.hpp"

#include <vector>

namespace experiments {

struct Cantilever {
    pbs::Character character;              // one bone in the held end
    std::vector<bool> held;                // #V
    std::vector<int> tip;                  // vertices within a mean edge of the free end
    std::vector<std::vector<int>> fifths;  // free vertices by fifths of the free length, from the held end on
    Eigen::VectorXd mass;                  // lumped rest volume [m^3], #V
    double mean_edge_m = 0.0;
};

Cantilever make_cantilever(const pbs::TetMesh& bar);

// How the finite elements hold it: the vertices in `held`, exactly.
FemOptions held_by_nodes(FemOptions options);

// Linear statics under gravity along -z: displacement [m], #V x 3, for young_pa, density_kg_m3 and 1 m/s^2.
struct ElasticSag {
    pbs::Positions displacement;
    FemOptions options;
};
ElasticSag elastic_sag(const Cantilever& cantilever, FemOptions options);

double mean_sag_m(const Cantilever& cantilever, const pbs::Positions& displacement);  // of the tip, downwards

}  // namespace experiments
