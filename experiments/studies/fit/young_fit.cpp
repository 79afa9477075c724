#include "experiments/studies/fit/young_fit.hpp"

#include "analysis/statistics.hpp"

#include <cmath>

namespace experiments {
namespace {

constexpr double range = 5.0;  // the modulus is looked for within this factor of the least squares' one

// Sum over some vertices of m a . b.
double product(const Cantilever& cantilever, const std::vector<int>& vertices, const pbs::Positions& a, const pbs::Positions& b)
{
    double sum = 0.0;
    for (const int v : vertices) sum += cantilever.body.mass_kg(v) * a.row(v).dot(b.row(v));
    return sum;
}

}  // namespace

YoungFit fit_young(const Cantilever& cantilever, const ElasticSag& elastic, const pbs::Positions& displacement, double gravity_m_s2)
{
    // Linear: the elastic body of modulus E is displaced by per_pa / E.
    const pbs::Positions per_pa = elastic.options.young_pa * gravity_m_s2 * elastic.displacement;
    std::vector<analysis::Misfit> misfits;
    double squares = 0.0, mixed = 0.0;
    for (const std::vector<int>& fifth : cantilever.fifths) {
        const double uu = product(cantilever, fifth, displacement, displacement), ue = product(cantilever, fifth, displacement, per_pa),
                     ee = product(cantilever, fifth, per_pa, per_pa);
        misfits.push_back([=](double young_pa) {
            return 100.0 * std::sqrt(std::max(0.0, (uu - 2.0 * ue / young_pa + ee / (young_pa * young_pa)) / uu));
        });
        squares += ee / uu;
        mixed += ue / uu;
    }
    const double start_pa = squares / mixed;  // minimises the sum of squared misfits in closed form
    if (!(start_pa > 0.0 && std::isfinite(start_pa))) {
        YoungFit none;
        none.young_pa.estimate = none.young_pa.low = none.young_pa.high = none.misfit_pct = analysis::not_known;
        return none;
    }
    const analysis::FittedParameter fit = analysis::fit_over_cases(misfits, start_pa / range, start_pa * range);
    return {fit.interval, fit.all.value, fit.all};
}

}  // namespace experiments
