// A bar that is held at one end, with the same tets and the same held vertices for PBS and for the finite elements; and Young's modulus of
// the linear elastic bar that hangs as another body does under the same gravity and density.
//   const Cantilever cantilever = make_cantilever(bar);
//   const YoungFit fit = fit_young(cantilever, elastic_sag(cantilever, options), pbs_displacement, 9.81);
//   fit.young_pa.estimate, fit.minimum.value
#pragma once

#include "analysis/statistics/minimise.hpp"
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

double mean_sag_m(const Cantilever& cantilever, const pbs::Positions& displacement);  // of the tip, downwards

// Linear statics under gravity along -z: displacement [m], #V x 3, for young_pa, density_kg_m3 and 1 m/s^2.
struct ElasticSag {
    pbs::Positions displacement;
    FemOptions options;
};
ElasticSag elastic_sag(const Cantilever& cantilever, FemOptions options);

struct YoungFit {
    // 95 %, leaving out one fifth of the free length at a time: wide where no single modulus bends as the body does.
    analysis::Interval young_pa;
    analysis::Minimum minimum;  // over Young's modulus [Pa]; its value is what is left: rms over the fifths of |u - u_elastic| / |u| [%]
};

// displacement [m], #V x 3, under gravity_m_s2 along -z with the density of the elastic sag. A displacement that is not finite, or against
// gravity, has no modulus: NaN, and the outcome not_finite.
YoungFit fit_young(const Cantilever& cantilever, const ElasticSag& elastic, const pbs::Positions& displacement, double gravity_m_s2);

}  // namespace experiments
