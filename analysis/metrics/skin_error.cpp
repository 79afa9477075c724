#include "analysis/metrics/skin_error.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/statistics/statistics.hpp"
#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace analysis {
namespace {

constexpr double compared_size_m = 1.7;
constexpr double share_of_p95 = 0.95, lost_area_share = 1e-12;

// The length is twice the triangle's area; the direction is that of its front.
pbs::Vec3 area_vector(const pbs::Positions& positions, const pbs::Triangles& skin, Eigen::Index face)
{
    const pbs::Vec3 a = positions.row(skin(face, 0));
    return (positions.row(skin(face, 1)).transpose() - a).cross(positions.row(skin(face, 2)).transpose() - a);
}

double angle_deg(const pbs::Vec3& one, const pbs::Vec3& other, double least_area)
{
    if (!one.allFinite() || !other.allFinite()) return not_known;
    if (one.norm() < least_area || other.norm() < least_area) return 180.0;
    return std::atan2(one.cross(other).norm(), one.dot(other)) * 180.0 / std::numbers::pi;
}

// Values of parts of the skin, with their areas.
struct Weighted {
    std::vector<double> values, weights;

    void add(double value, double weight)
    {
        values.push_back(value);
        weights.push_back(weight);
    }
    double mean_of(double (*term)(double)) const
    {
        CompensatedSum sum, total;
        for (std::size_t i = 0; i < values.size(); ++i) {
            sum += weights[i] * term(values[i]);
            total += weights[i];
        }
        return total.value() > 0.0 ? sum.value() / total.value() : not_known;
    }
};

}  // namespace

double removed_share_pct(double error, double of_other)
{
    return error > 0.0 ? 100.0 * (1.0 - of_other / error) : not_known;
}

double weighted_quantile(const std::vector<double>& values, const std::vector<double>& weights, double share)
{
    if (std::ranges::any_of(values, [](double value) { return std::isnan(value); })) return not_known;
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    double total = 0.0, below = 0.0;
    for (const std::size_t i : order) total += weights[i];
    for (const std::size_t i : order)
        if ((below += weights[i]) >= share * total && below > 0.0) return values[i];
    return not_known;
}

SkinErrorMetrics::SkinErrorMetrics(const pbs::Positions& rest, const pbs::Tets& tets) : skin_(pbs::boundary_of(tets))
{
    checked_rest_volumes(rest, tets);
    area_m2_.resize(skin_.rows());
    vertex_area_m2_ = Eigen::VectorXd::Zero(rest.rows());
    Eigen::AlignedBox3d box;
    for (Eigen::Index face = 0; face < skin_.rows(); ++face) {
        area_m2_(face) = 0.5 * area_vector(rest, skin_, face).norm();
        for (int k = 0; k < 3; ++k) {
            vertex_area_m2_(skin_(face, k)) += area_m2_(face) / 3.0;
            box.extend(pbs::Vec3(rest.row(skin_(face, k))));
        }
    }
    diagonal_m_ = box.diagonal().norm();
    extent_m_ = box.sizes().maxCoeff();
}

SkinError SkinErrorMetrics::measure(const pbs::Positions& positions, const pbs::Positions& reference,
                                    const std::vector<bool>& left_out) const
{
    require_points(positions, vertex_area_m2_.size(), "the frame");
    require_points(reference, vertex_area_m2_.size(), "the reference");
    require_entries(left_out, vertex_area_m2_.size());
    Weighted apart_m, turned_deg;
    for (Eigen::Index v = 0; v < vertex_area_m2_.size(); ++v) {
        const double distance_m = (positions.row(v) - reference.row(v)).norm();
        if (vertex_area_m2_(v) > 0.0 && !left_out[v])
            apart_m.add(std::isfinite(distance_m) ? distance_m : not_known, vertex_area_m2_(v));
    }
    for (Eigen::Index face = 0; face < skin_.rows(); ++face)
        if (!left_out[skin_(face, 0)] && !left_out[skin_(face, 1)] && !left_out[skin_(face, 2)])
            turned_deg.add(angle_deg(area_vector(positions, skin_, face), area_vector(reference, skin_, face),
                                     2.0 * lost_area_share * area_m2_(face)),
                           area_m2_(face));
    const double rms_m = std::sqrt(apart_m.mean_of([](double value) { return value * value; })),
                 to_mm = 1e3 * compared_size_m / extent_m_;
    const auto largest_m = std::ranges::max_element(apart_m.values);
    return {.rms_mm = to_mm * rms_m,
            .p95_mm = to_mm * weighted_quantile(apart_m.values, apart_m.weights, share_of_p95),
            .largest_mm = std::isnan(rms_m) ? not_known : to_mm * *largest_m,
            .rms_pct = 100.0 * rms_m / diagonal_m_,
            .normals_mean_deg = turned_deg.mean_of([](double value) { return value; }),
            .normals_p95_deg = weighted_quantile(turned_deg.values, turned_deg.weights, share_of_p95)};
}

}  // namespace analysis
