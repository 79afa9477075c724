// A bar held at one end, the same tets and the same held vertices for the position based solver and for the finite elements.
//   const Cantilever cantilever = make_cantilever(bar);
//   mean_sag_m(cantilever, elastic_sag(cantilever, options).displacement);
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/shared/loaded_body.hpp"

#include <vector>

namespace experiments {

struct Cantilever {
    LoadedBody body;
    std::vector<int> tip;                  // vertices within a mean edge of the free end
    std::vector<std::vector<int>> fifths;  // free vertices by fifths of the free length, from the held end on
    double mean_edge_m = 0.0;
};

Cantilever make_cantilever(const pbs::TetMesh& bar);

// Linear statics under gravity along -z: displacement [m], #V x 3, for young_pa, density_kg_m3 and 1 m/s^2.
struct ElasticSag {
    pbs::Positions displacement;
    FemOptions options;
};
ElasticSag elastic_sag(const Cantilever& cantilever, FemOptions options);

double mean_sag_m(const Cantilever& cantilever, const pbs::Positions& displacement);  // of the tip, downwards

}  // namespace experiments
