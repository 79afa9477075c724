// The distance of a result on a mesh from the limit under refinement: Richardson extrapolation and the grid convergence index (GCI).
//   const GridConvergence twist = three_grids({6.063, 5.972, 5.863}, {1.5, 4.0 / 3.0}, 2.0);   // twist.observed_order: 1.53
//   const double bar = two_fields(error_l2_pct, 2.0, 1.0).bounds[1];                           // of the coarser of two fields
// P. J. Roache, Journal of Fluids Engineering 116, 1994: a bound is the distance from the extrapolated limit times a safety factor, which
// is 3 for two grids with a presumed order, and 1.25 for three grids with their observed order. I. B. Celik et al., Journal of Fluids
// Engineering 130, 2008: unequal ratios. L. Eca, M. Hoekstra, Computers and Fluids 38, 2009: where grids do not converge monotonically, the
// bound is 3 times the largest difference. Grid 1 is the finest. Values and bounds have the unit of the measured quantity; the GCI of the
// literature is bounds[0] / |value|.
#pragma once

#include <array>
#include <vector>

namespace analysis {

// How the values change from grid to grid.
enum class GridBehaviour {
    presumed,     // two grids: nothing is observed
    monotone,     // differences of one sign that decrease
    oscillating,  // alternating signs
    diverging,    // the differences do not decrease under refinement: the observed order is 0 or less
    constant,     // all values are equal
    not_finite,   // a value is not finite, and so no bound is
};
const char* name_of(GridBehaviour behaviour);  // as it is spelt in the enum

// Oscillating, diverging and not_finite have no limit; their bounds come from the range of the values.
struct GridConvergence {
    GridBehaviour behaviour = GridBehaviour::presumed;  // presumed and constant also have a limit
    double observed_order = 0.0;                        // NaN if none can be observed; for an oscillating series Celik's apparent order
    double order = 0.0;  // the order in use: the observed one, limited by the formal one, since a higher one would be optimistic; for two
                         // grids the presumed one
    double safety_factor = 0.0;  // 3 for two grids and where there is no limit, otherwise 1.25
    double extrapolated = 0.0;   // the limit; NaN for fields and where there is none
    std::vector<double> bounds;  // bounds on each grid's distance from the limit, the finest grid first
    bool asymptotic = false;     // monotone, and observed within a tenth of the formal order: the limit itself is credible
};

// Values of the finer and the coarser grid; the ratio of their mesh sizes, > 1; the presumed order of convergence. InputError unless ratio
// > 1 and order > 0, both finite. The same holds for all functions below.
GridConvergence two_grids(const std::array<double, 2>& values, double ratio, double order);
// Values on grids 1, 2, 3; ratios h2 / h1 and h3 / h2; the theoretical order.
GridConvergence three_grids(const std::array<double, 3>& values, const std::array<double, 2>& ratios, double formal_order);

// Like two_grids, for two fields that are known by the norm of their difference; the bounds use the same norm. Three or more fields are
// fitted (nested_convergence.hpp).
GridConvergence two_fields(double difference, double ratio, double order);

// The p of f + C h^p through three values, from R = (f3 - f2) / (f2 - f1). It is 0 or negative if they diverge; for R < 0 it is Celik's p.
double observed_order_of_three(double difference_ratio, const std::array<double, 2>& ratios);

}  // namespace analysis
