// The distance of a result on a mesh from the limit under refinement, from four nested solutions: Richardson's
// extrapolation, and a safety factor (P. J. Roache, Journal of Fluids Engineering 116, 1994). observed_order (fits.hpp)
// finds an order on any number of meshes whose errors are known.
#pragma once

#include <algorithm>
#include <cmath>

namespace analysis {

// The distances of the other solutions from the quadratic one on the refined tets, in any norm and unit.
struct NestedDistances {
    double linear = 0.0;          // linear elements, unrefined tets
    double linear_refined = 0.0;  // linear elements, refined tets
    double quadratic = 0.0;       // quadratic elements, unrefined tets
};

struct NestedOrder {
    double observed =
        0.0;  // below 0 where the linear solutions move away from the finest one; NaN where all solutions are equal
    double order = 0.0;  // the order that is used: the observed one, at least 0.5 and at most the formal one
    // The linear solutions are in the range where errors fall as they should: 0.95 <= observed <= formal order + 0.1
    // (the upper limit: L. Eca, M. Hoekstra, Journal of Computational Physics 262, 2014); and the unrefined quadratic
    // solution is at least twice as close to the finest one as the refined linear one is. In folds neither holds, and
    // the order is no measure of the error.
    bool reliable = false;
    double safety_factor = 0.0;  // 1.25 if reliable, otherwise 3

    // Returns a bound on the distance of the finest solution from the limit, in the norm and unit of the argument.
    // quadratic: as NestedDistances::quadratic, in any norm.
    double bound(double quadratic) const { return safety_factor * quadratic / (std::exp2(order) - 1.0); }
};

// The error of finite elements from four nested solutions: linear and quadratic elements on some tets and on the same
// tets cut into eight. The quadratic solution on the refined tets stands for the limit in the observed order of the
// linear ones,
//   2^p = |linear, unrefined - quadratic, refined| / |linear, refined - quadratic, refined|.
// Quadratic elements converge at least as fast as linear ones on the same meshes. Where the finest solution is much
// closer to the limit than the linear ones, p is therefore cautious for it, and its distance from the limit is at most
// |quadratic, unrefined - quadratic, refined| / (2^p - 1), times a safety factor. Norms are compared, not the fields
// point by point: nodal errors of finite elements are not proportional to each other. The order is not a least squares
// fit of a power law to the four solutions: only two of them are of one element order, so that no residual would be
// left to judge the fit by, and a third mesh of that order would have 64 times as many tets. With nested meshes and a
// ratio of 2, the two distances determine the order of the linear solutions. fits.hpp fits errors on three or more
// meshes.
//   const NestedOrder order = nested_order({.linear = 2.0, .linear_refined = 0.6, .quadratic = 0.1}, 2.0);
//   order.bound(0.1);         // of the quadratic solution on the refined tets
//   2.0 + order.bound(0.1);   // of any other one, by the triangle inequality
// formal_order: of linear elements, > 0. Distances are >= 0.
inline NestedOrder nested_order(const NestedDistances& distances, double formal_order)
{
    constexpr double lowest_order = 0.5, reliable_order = 0.95, above_formal = 0.1, closer_by = 2.0;
    NestedOrder order;
    order.observed = std::log2(distances.linear / distances.linear_refined);
    order.order = std::isnan(order.observed)
                      ? formal_order
                      : std::clamp(order.observed, std::min(lowest_order, formal_order), formal_order);
    order.reliable = order.observed >= std::min(reliable_order, formal_order) &&
                     order.observed <= formal_order + above_formal &&
                     closer_by * distances.quadratic <= distances.linear_refined;
    order.safety_factor = order.reliable ? 1.25 : 3.0;
    return order;
}

}  // namespace analysis
