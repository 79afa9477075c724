// The closest points of a point and a triangle, or of two edges: their distance with its first and second derivatives,
// and how far the points may move along straight lines before they meet.
//   const ClosestPoints closest = closest_points(PairKind::point_triangle, points);
//   closest.distance_m, distance_gradient(closest), distance_hessian(closest, points)
//   const double share = safe_share(PairKind::point_triangle, points, step, 1.0);
// The distance is once continuously differentiable where it is positive, except between parallel edges; its Hessian
// jumps where the closest points pass from the inside of a triangle or an edge to its boundary. The method for the
// derivatives is that of the implicit function theorem: the closest points follow the corners, so that no case needs
// formulas of its own.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace reference_fem {

enum class PairKind { point_triangle, edge_edge };

// Columns [m]: the point and the corners of the triangle; or the ends of the first edge and those of the second one.
using FourPoints = Eigen::Matrix<double, 3, 4>;
using FourPointGradient = Eigen::Matrix<double, 12, 1>;  // entry 3 i + c: component c of point i
using FourPointHessian = Eigen::Matrix<double, 12, 12>;

// The offset between the closest points is r = sum_i v_i x_i, with weights v_i that are affine in the parameters s_k of
// the closest points: two inside a triangle or inside both edges, one on an edge, none at a corner.
struct ClosestPoints {
    Eigen::Vector4d weights = Eigen::Vector4d::Zero();  // v_i; their sum is 0
    // d v_i / d s_k, in the first `parameters` columns
    Eigen::Matrix<double, 4, 2> slopes = Eigen::Matrix<double, 4, 2>::Zero();
    int parameters = 0;
    pbs::Vec3 offset = pbs::Vec3::Zero();  // r [m], towards the point or the first edge
    double distance_m = 0.0;               // |r|

    // Whether a point has a part in the offset. The others do not feel the distance.
    bool uses(int point) const { return weights(point) != 0.0 || !slopes.row(point).isZero(0.0); }
};

// A triangle without area counts as its edges, and an edge without length as a point.
ClosestPoints closest_points(PairKind kind, const FourPoints& points);
// The points are a point (column 0) and the ends of an edge (columns 1 and 2). Column 3 is not used; its weight is 0.
ClosestPoints closest_on_edge(const FourPoints& points);
// The points are columns 0 and 1. The other columns are not used; their weights are 0.
ClosestPoints closest_of_two(const FourPoints& points);

// Both need a distance > 0. [1] and [1/m].
FourPointGradient distance_gradient(const ClosestPoints& closest);
FourPointHessian distance_hessian(const ClosestPoints& closest, const FourPoints& points);

// |e x f|^2 [m^4] of the two edges e and f, and its derivatives [m^3], [m^2]. It is 0 where they are parallel, so that
// the closest points can jump.
struct EdgeCross {
    double squared_m4 = 0.0;
    FourPointGradient gradient;
    FourPointHessian hessian;
};
EdgeCross edge_cross(const FourPoints& points);

// The largest share of `step` [m], at most `most`, after which the pair still has a tenth of its distance, by additive
// conservative advancement: M. Li, D. Kaufman, C. Jiang, Codimensional Incremental Potential Contact, ACM TOG 40(4),
// 2021, Sec. 5. It is never too large; where the step is longer than the distance, it can be smaller than necessary by
// less than 0.1 %.
double safe_share(PairKind kind, FourPoints points, FourPoints step, double most);

}  // namespace reference_fem
