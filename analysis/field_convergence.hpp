// The limit of fields under refinement, with their observed order of convergence: the least squares fit of
//   x_i = x_0 + e h_i^p + r_i
// to fields x_i on meshes of size h_i, point by point, with one order p for all points. L. Eca, M. Hoekstra, Journal of Computational
// Physics 262, 2014, apply it to single values; here the limit x_0 and the amplitude e are fields.
//   const FieldConvergence fit = fit_fields({on_h, on_2h, on_4h}, {1.0, 2.0, 4.0}, 3.0, mass);
//   const double bound = bound_of(fit, fields, 0, [&](const auto& a, const auto& b) { return error_metrics.measure(a, b).joint_pct; });
// Mesh 1 is the finest. The theoretical order limits the one in use, since a higher one would be optimistic.
#pragma once

#include "pbs/geometry/types.hpp"

#include <functional>
#include <vector>

namespace analysis {

struct FieldConvergence {
    // The order of the best fit within (0, 2 formal order]. NaN where the fields do not approach a limit: their differences grow under
    // refinement, or successive differences have opposite directions.
    double observed_order = 0.0;
    double order = 0.0;          // in use: the observed one, or the formal one where that is lower
    bool reliable = false;       // the order lies between half the formal one and that plus 0.1, and the fit explains the differences
    double safety_factor = 0.0;  // 1.25 if reliable, otherwise 3
    pbs::Positions limit;        // x_0, with the order in use; not a number where no order was observed
    std::vector<pbs::Positions> residuals;  // r_i, one per field
    double unexplained = 0.0;               // |r| / |differences from the mean field|, 0 to 1
};

// fields: three or more, the finest first, in any unit, all #P x 3; sizes: increasing, each at least 1.3 times the one before (Celik et al.
// 2008); weights: of the points, #P, >= 0, or empty for equal ones: points of weight 0 do not count. pbs::InputError otherwise, and for
// fields that are not finite where they count.
FieldConvergence fit_fields(const std::vector<pbs::Positions>& fields, const std::vector<double>& sizes, double formal_order,
                            const Eigen::VectorXd& weights = {});

// The distance of two fields in some norm: norm(a - b).
using FieldDistance = std::function<double(const pbs::Positions&, const pbs::Positions&)>;

// A bound on the distance of field `which` from the limit, after Eca and Hoekstra 2014: the safety factor times its distance from
// fit.limit, plus its own residual and the standard deviation of the fit; where at least half of the differences is unexplained, 3 times
// their sum. Where no order was observed, 3 times the largest distance of two fields. NaN if a distance is NaN. The arguments are those of
// the fit.
double bound_of(const FieldConvergence& fit, const std::vector<pbs::Positions>& fields, std::size_t which, const FieldDistance& distance);

}  // namespace analysis
