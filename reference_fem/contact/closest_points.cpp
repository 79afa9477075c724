#include "reference_fem/contact/closest_points.hpp"

#include <algorithm>
#include <cmath>

namespace reference_fem {
namespace {

using pbs::Vec3;

constexpr double parallel = 1e-14;      // |e x f|^2 over |e|^2 |f|^2: below, the inner parameters are not determined
constexpr double kept_distance = 0.1;   // share of the distance that a step leaves
constexpr double smallest_gain = 1e-4;  // of the share reached: a smaller one ends the advancement
constexpr int most_advances = 1000;

ClosestPoints finished(ClosestPoints closest, const FourPoints& points)
{
    closest.offset = points * closest.weights;
    closest.distance_m = closest.offset.norm();
    return closest;
}

// Between column `point`, with weight `sign`, and the edge of columns a and b, with the opposite one.
ClosestPoints point_and_edge(const FourPoints& points, int point, int a, int b, double sign)
{
    const Vec3 edge = points.col(b) - points.col(a);
    const double squared = edge.squaredNorm(), along = edge.dot(points.col(point) - points.col(a));
    const double s = squared > 0.0 ? std::clamp(along / squared, 0.0, 1.0) : 0.0;
    ClosestPoints closest;
    closest.weights(point) = sign;
    closest.weights(a) = -sign * (1.0 - s);
    closest.weights(b) = -sign * s;
    if (s > 0.0 && s < 1.0) {
        closest.parameters = 1;
        closest.slopes(a, 0) = sign;
        closest.slopes(b, 0) = -sign;
    }
    return finished(closest, points);
}

const ClosestPoints& nearer(const ClosestPoints& one, const ClosestPoints& other)
{
    return other.distance_m < one.distance_m ? other : one;
}

ClosestPoints point_triangle(const FourPoints& points)
{
    const Vec3 p = points.col(0), a = points.col(1), b = points.col(2), c = points.col(3);
    const Vec3 normal = (b - a).cross(c - a);
    const double squared = normal.squaredNorm();
    const Vec3 inside(normal.dot((b - p).cross(c - p)), normal.dot((c - p).cross(a - p)),
                      normal.dot((a - p).cross(b - p)));
    if (squared > 0.0 && inside.minCoeff() > 0.0) {
        ClosestPoints closest;
        closest.weights << 1.0, -inside / squared;
        closest.weights(1) = -(1.0 + closest.weights(2) + closest.weights(3));
        closest.parameters = 2;
        closest.slopes.col(0) << 0.0, 1.0, -1.0, 0.0;
        closest.slopes.col(1) << 0.0, 1.0, 0.0, -1.0;
        return finished(closest, points);
    }
    return nearer(nearer(point_and_edge(points, 0, 1, 2, 1.0), point_and_edge(points, 0, 2, 3, 1.0)),
                  point_and_edge(points, 0, 3, 1, 1.0));
}

ClosestPoints edge_edge(const FourPoints& points)
{
    const Vec3 e = points.col(1) - points.col(0), f = points.col(3) - points.col(2),
               between = points.col(0) - points.col(2);
    const double ee = e.squaredNorm(), ff = f.squaredNorm(), ef = e.dot(f), determinant = ee * ff - ef * ef;
    if (determinant > parallel * ee * ff) {
        const double s = (ef * f.dot(between) - ff * e.dot(between)) / determinant,
                     t = (ee * f.dot(between) - ef * e.dot(between)) / determinant;
        if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
            ClosestPoints closest;
            closest.weights << 1.0 - s, s, t - 1.0, -t;
            closest.parameters = 2;
            closest.slopes.col(0) << -1.0, 1.0, 0.0, 0.0;
            closest.slopes.col(1) << 0.0, 0.0, 1.0, -1.0;
            return finished(closest, points);
        }
    }
    return nearer(nearer(point_and_edge(points, 0, 2, 3, 1.0), point_and_edge(points, 1, 2, 3, 1.0)),
                  nearer(point_and_edge(points, 2, 0, 1, -1.0), point_and_edge(points, 3, 0, 1, -1.0)));
}

}  // namespace

ClosestPoints closest_points(PairKind kind, const FourPoints& points)
{
    return kind == PairKind::point_triangle ? point_triangle(points) : edge_edge(points);
}

ClosestPoints closest_on_edge(const FourPoints& points)
{
    return point_and_edge(points, 0, 1, 2, 1.0);
}

ClosestPoints closest_of_two(const FourPoints& points)
{
    ClosestPoints closest;
    closest.weights << 1.0, -1.0, 0.0, 0.0;
    return finished(closest, points);
}

// d = |r| and dr / ds_k . r = 0, hence grad_i d = v_i r / d.
FourPointGradient distance_gradient(const ClosestPoints& closest)
{
    FourPointGradient gradient;
    for (int i = 0; i < 4; ++i) gradient.segment<3>(3 * i) = closest.weights(i) / closest.distance_m * closest.offset;
    return gradient;
}

// The closest points follow the corners: with t_k = dr / ds_k, G_kl = t_k . t_l and N_k of the blocks (dv_i / ds_k) r +
// v_i t_k, the Hessian of d^2 is 2 (v v^T (x) I - N G^-1 N^T).
FourPointHessian distance_hessian(const ClosestPoints& closest, const FourPoints& points)
{
    FourPointHessian half;  // of the Hessian of d^2
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            half.block<3, 3>(3 * i, 3 * j) = closest.weights(i) * closest.weights(j) * Eigen::Matrix3d::Identity();
    if (const int n = closest.parameters; n > 0) {
        const Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 2> tangents = points * closest.slopes.leftCols(n);
        Eigen::Matrix<double, 12, Eigen::Dynamic, 0, 12, 2> mixed(12, n);
        for (int k = 0; k < n; ++k)
            for (int i = 0; i < 4; ++i)
                mixed.col(k).segment<3>(3 * i) =
                    closest.slopes(i, k) * closest.offset + closest.weights(i) * tangents.col(k);
        const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2> metric = tangents.transpose() * tangents;
        half -= mixed * metric.inverse() * mixed.transpose();
    }
    const FourPointGradient gradient = distance_gradient(closest);
    return (half - gradient * gradient.transpose()) / closest.distance_m;
}

// |e x f|^2 = |e|^2 |f|^2 - (e . f)^2.
EdgeCross edge_cross(const FourPoints& points)
{
    const Vec3 e = points.col(1) - points.col(0), f = points.col(3) - points.col(2);
    const double ee = e.squaredNorm(), ff = f.squaredNorm(), ef = e.dot(f);
    const Vec3 by_e = 2.0 * (ff * e - ef * f), by_f = 2.0 * (ee * f - ef * e);
    const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d by_ee = 2.0 * (ff * identity - f * f.transpose()),
                          by_ff = 2.0 * (ee * identity - e * e.transpose()),
                          by_ef = 4.0 * e * f.transpose() - 2.0 * f * e.transpose() - 2.0 * ef * identity;
    EdgeCross cross;
    cross.squared_m4 = e.cross(f).squaredNorm();
    cross.gradient << -by_e, by_e, -by_f, by_f;
    constexpr double sign[4] = {-1.0, 1.0, -1.0, 1.0};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const Eigen::Matrix3d block =
                i < 2 ? (j < 2 ? by_ee : by_ef) : (j < 2 ? Eigen::Matrix3d(by_ef.transpose()) : by_ff);
            cross.hessian.block<3, 3>(3 * i, 3 * j) = sign[i] * sign[j] * block;
        }
    return cross;
}

double safe_share(PairKind kind, FourPoints points, FourPoints step, double most)
{
    step.colwise() -= Vec3(step.rowwise().mean());  // a motion of all four changes no distance
    const Eigen::RowVector4d length = step.colwise().norm();
    const double speed = kind == PairKind::point_triangle ? length(0) + length.tail<3>().maxCoeff()
                                                          : length.head<2>().maxCoeff() + length.tail<2>().maxCoeff();
    if (speed == 0.0) return most;
    double distance_m = closest_points(kind, points).distance_m, share = 0.0;
    const double kept_m = kept_distance * distance_m;
    for (int k = 0; k < most_advances; ++k) {
        const double gain = (distance_m - kept_m) / speed;
        if (share + gain >= most) return most;
        share += gain;
        if (gain <= smallest_gain * share) break;
        points += gain * step;
        distance_m = closest_points(kind, points).distance_m;
    }
    return share;
}

}  // namespace reference_fem
