// The distance of a result on a mesh from the limit under refinement, from two meshes: Richardson extrapolation and the grid convergence
// index (GCI).
//   const double bar = two_fields(error_l2_pct, 2.0, 1.0).bounds[1];   // of the coarser of two fields
// P. J. Roache, Journal of Fluids Engineering 116, 1994: a bound is the distance from the extrapolated limit times a safety factor, which
// is 3 for two grids with a presumed order. I. B. Celik et al., Journal of Fluids Engineering 130, 2008: the mesh sizes should differ by a
// factor of at least 1.3, since the difference of more similar meshes is mostly noise. Grid 1 is the finer one. Values and bounds have the
// unit of the measured quantity; the GCI of the literature is bounds[0] / |value|. With two grids no order is observed:
// nested_order observes it from four nested solutions, and observed_order (fits.hpp) from the errors on any number of meshes.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

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

// The distances of the other solutions from the quadratic one on the refined tets, in any norm and unit.
struct NestedDistances {
    double linear = 0.0;          // linear elements, unrefined tets
    double linear_refined = 0.0;  // linear elements, refined tets
    double quadratic = 0.0;       // quadratic elements, unrefined tets
};

struct NestedOrder {
    double observed = 0.0;  // below 0 where the linear solutions move away from the finest one; NaN where all solutions are equal
    double order = 0.0;     // the order that is used: the observed one, at least 0.5 and at most the formal one
    // 0.5 <= observed <= formal order + 0.1 (L. Eca, M. Hoekstra, Journal of Computational Physics 262, 2014), and the unrefined quadratic
    // solution is closer to the finest one than the refined linear one is.
    bool reliable = false;
    double safety_factor = 0.0;  // 1.25 if reliable, otherwise 3

    // Returns a bound on the distance of the finest solution from the limit, in the norm and unit of the argument. quadratic: as
    // NestedDistances::quadratic, in any norm.
    double bound(double quadratic) const;
};

// The error of finite elements from four nested solutions: linear and quadratic elements on some tets and on the same tets cut into eight.
// The quadratic solution on the refined tets stands for the limit in the observed order of the linear ones,
//   2^p = |linear, unrefined - quadratic, refined| / |linear, refined - quadratic, refined|.
// Quadratic elements converge at least as fast as linear ones on the same meshes. Where the finest solution is much closer to the limit
// than the linear ones, p is therefore cautious for it, and its distance from the limit is at most
// |quadratic, unrefined - quadratic, refined| / (2^p - 1), times a safety factor. Norms are compared, not the fields point by point: nodal
// errors of finite elements are not proportional to each other.
// The order is not a least squares fit of a power law to the four solutions: only two of them are of one element order, so that no residual
// would be left to judge the fit by, and a third mesh of that order would have 64 times as many tets. With nested meshes and a ratio of 2,
// the two distances determine the order of the linear solutions. fits.hpp fits errors on three or more meshes.
//   const NestedOrder order = nested_order({.linear = 2.0, .linear_refined = 0.6, .quadratic = 0.1}, 2.0);
//   order.bound(0.1);         // of the quadratic solution on the refined tets
//   2.0 + order.bound(0.1);   // of any other one, by the triangle inequality
// Where the finest solution was not reached, the other three give a wider bound (order_without_finest).
// formal_order: of linear elements, > 0. Distances are >= 0.
NestedOrder nested_order(const NestedDistances& distances, double formal_order);

// Where the quadratic solution on the refined tets was not reached, the quadratic one on the unrefined tets stands for the limit in the
// observed order of the linear ones. The refined linear solution is then at most bound(|linear - linear, refined|) from the limit, and the
// quadratic one at most |quadratic - linear, refined| more. The order is never reliable: no finer solution confirms it.
// linear, linear_refined: the distances of these solutions from the quadratic one on the unrefined tets.
NestedOrder order_without_finest(double linear, double linear_refined, double formal_order);

// Richardson's extrapolation from two nested solutions of one method that converges with this order > 0, #V x 3.
pbs::Positions extrapolated(const pbs::Positions& refined, const pbs::Positions& unrefined, double order);

}  // namespace analysis
