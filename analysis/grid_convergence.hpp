// The distance of a result on a mesh from the limit under refinement, from two meshes: Richardson extrapolation and the grid convergence
// index (GCI).
//   const double bar = two_fields(error_l2_pct, 2.0, 1.0).bounds[1];   // of the coarser of two fields
// P. J. Roache, Journal of Fluids Engineering 116, 1994: a bound is the distance from the extrapolated limit times a safety factor, which
// is 3 for two grids with a presumed order. I. B. Celik et al., Journal of Fluids Engineering 130, 2008: the mesh sizes should differ by a
// factor of at least 1.3, since the difference of more similar meshes is mostly noise. Grid 1 is the finer one. Values and bounds have the
// unit of the measured quantity; the GCI of the literature is bounds[0] / |value|. With two grids no order is observed.
// nested_convergence.hpp observes it from four nested solutions, and line_fit.hpp from the errors on any number of meshes.
#pragma once

#include <array>

namespace analysis {

constexpr double grid_safety_factor = 3.0;   // Roache, for two grids
constexpr double smallest_grid_ratio = 1.3;  // Celik et al.

struct GridConvergence {
    double extrapolated = 0.0;          // the limit; NaN for fields, and where a value is not finite
    std::array<double, 2> bounds = {};  // bounds on the distances of the finer and the coarser grid from the limit
};

// Values of the finer and the coarser grid; the ratio of their mesh sizes; the presumed order of convergence. InputError unless the ratio
// is at least 1.3 and the order > 0, both finite.
GridConvergence two_grids(const std::array<double, 2>& values, double ratio, double order);

// Like two_grids, for two fields that are known by the norm of their difference; the bounds use the same norm.
GridConvergence two_fields(double difference, double ratio, double order);

}  // namespace analysis
