// How far a result on a mesh is from the limit of ever finer ones: Richardson extrapolation and the grid convergence index (GCI).
//   const GridConvergence twist = three_grids({6.063, 5.972, 5.863}, {1.5, 4.0 / 3.0}, 2.0);   // twist.observed_order: 1.53
//   const double bar = two_fields(error_l2_pct, 2.0, 1.0).bounds[1];                           // of the coarser of two fields
// P. J. Roache, Journal of Fluids Engineering 116, 1994: a bound is the distance from the extrapolated limit times a factor, 3 for two
// grids and an order that is presumed, 1.25 for three and the order they show. I. B. Celik et al., Journal of Fluids Engineering 130, 2008:
// unequal ratios. L. Eca, M. Hoekstra, Computers and Fluids 38, 2009: where grids do not converge monotonically, 3 times the largest
// difference. Grid 1 is the finest. Values and bounds are in the unit of what is asked; in print GCI is bounds[0] / |value|.
#pragma once

#include "pbs/geometry/types.hpp"

#include <array>
#include <vector>

namespace analysis {

// What the values do from grid to grid.
enum class GridBehaviour {
    presumed,     // two grids: nothing is observed
    monotone,     // differences of one sign that become smaller
    oscillating,  // of alternating signs; of fields: successive differences point against each other
    diverging,    // differences that do not become smaller than a constant for ever finer grids: observed order 0 or less
    constant,     // no difference at all
    not_finite,   // a value is not, so that no bound is
};
const char* name_of(GridBehaviour behaviour);  // as it is spelt in the enum

// Oscillating, diverging and not_finite: no limit, bounds by the range of the values.
struct GridConvergence {
    GridBehaviour behaviour = GridBehaviour::presumed;  // presumed and constant have a limit too
    double observed_order = 0.0;                        // NaN where none can be observed; of an oscillating series Celik's apparent order
    double order = 0.0;  // the one used: observed, but no higher than the formal one, which would be optimistic; presumed on two grids
    double safety_factor = 0.0;  // 3 for two grids and where there is no limit, else 1.25
    double extrapolated = 0.0;   // the limit; NaN for fields and where there is none to see
    std::vector<double> bounds;  // of each grid's distance from the limit, finest first
    bool asymptotic = false;     // monotone and observed within a tenth of the formal order: the limit itself may be believed
};

// Values of the finer and the coarser grid; ratio of their mesh sizes, > 1; the order they are presumed to converge with. InputError unless
// ratio > 1 and order > 0, both finite; so of all below.
GridConvergence two_grids(const std::array<double, 2>& values, double ratio, double order);
// Values on grids 1, 2, 3; ratios h2 / h1 and h3 / h2; the order that theory gives.
GridConvergence three_grids(const std::array<double, 3>& values, const std::array<double, 2>& ratios, double formal_order);

// Norms of the differences between fields, on the points that all grids have.
struct FieldDifferences {
    double fine_middle = 0.0, middle_coarse = 0.0, fine_coarse = 0.0;  // |f1 - f2|, |f2 - f3|, |f1 - f3|
    double alignment() const;  // cosine of the angle between f1 - f2 and f2 - f3: 1 where f + h^p e holds with one error field e
};
// As two_grids and three_grids, of fields that are known by the norms of their differences; bounds are in that norm.
GridConvergence two_fields(double difference, double ratio, double order);
// ratios h2 / h1 and h3 / h2; the sign of the alignment tells whether they oscillate.
GridConvergence three_fields(const FieldDifferences& differences, const std::array<double, 2>& ratios, double formal_order);

// The field f1 + (f1 - f2) / (r^p - 1), point by point; InputError for fields of different numbers of points.
pbs::Positions extrapolated_field(const pbs::Positions& fine, const pbs::Positions& coarse, double ratio, double order);

// The p of f + C h^p through three values, from R = (f3 - f2) / (f2 - f1); 0 or negative where they diverge. For R < 0 Celik's p.
double observed_order_of_three(double difference_ratio, const std::array<double, 2>& ratios);

}  // namespace analysis
