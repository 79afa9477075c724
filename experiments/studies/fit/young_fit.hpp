// Young's modulus of a linear elastic body that hangs as another body does under the same gravity and density.
//   const YoungFit fit = fit_young(cantilever, elastic_sag(cantilever, options), pbs_displacement, 9.81);
//   fit.young_pa.estimate, fit.misfit_pct
#pragma once

#include "analysis/minimise.hpp"
#include "experiments/studies/fit/cantilever.hpp"

namespace experiments {

struct YoungFit {
    analysis::Interval
        young_pa;             // 95 %, leaving out one fifth of the free length at a time: wide where no one modulus bends as the body does
    double misfit_pct = 0.0;  // rms over the fifths of |u - u_elastic| / |u|, what is left
    analysis::Minimum minimum;  // in Young's modulus [Pa]
};

// A displacement that is not finite, or against gravity, has none: NaN, outcome not_finite. displacement [m], #V x 3, under gravity_m_s2
// along -z with the density of the elastic sag.
YoungFit fit_young(const Cantilever& cantilever, const ElasticSag& elastic, const pbs::Positions& displacement, double gravity_m_s2);

}  // namespace experiments
