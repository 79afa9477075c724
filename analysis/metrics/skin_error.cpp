#include "analysis/metrics/skin_error.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace analysis {
namespace {

constexpr double compared_height_m = 1.7;
constexpr double most = 0.95;  // of the skin

// Twice the area and the direction of a triangle's front.
pbs::Vec3 area_vector(const pbs::Positions& positions, const pbs::Triangles& skin, Eigen::Index face)
{
    const pbs::Vec3 a = positions.row(skin(face, 0));
    return (positions.row(skin(face, 1)).transpose() - a).cross(positions.row(skin(face, 2)).transpose() - a);
}

double angle_deg(const pbs::Vec3& one, const pbs::Vec3& other)
{
    const bool has_both = one.norm() != 0.0 && other.norm() != 0.0;
    return has_both ? std::atan2(one.cross(other).norm(), one.dot(other)) * 180.0 / std::numbers::pi : 180.0;
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
        for (std::size_t i = 0; i < values.size(); ++i) sum += weights[i] * term(values[i]), total += weights[i];
        return total.value() > 0.0 ? sum.value() / total.value() : std::numeric_limits<double>::quiet_NaN();
    }
};

}  // namespace

double removed_share_pct(double error, double of_other)
{
    return error > 0.0 ? 100.0 * (1.0 - of_other / error) : std::numeric_limits<double>::quiet_NaN();
}

double weighted_quantile(const std::vector<double>& values, const std::vector<double>& weights, double share)
{
    constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
    if (std::ranges::any_of(values, [](double value) { return std::isnan(value); })) return not_known;
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    const double wanted = share * std::accumulate(weights.begin(), weights.end(), 0.0);
    double below = 0.0;
    for (const std::size_t i : order)
        if ((below += weights[i]) >= wanted && below > 0.0) return values[i];
    return order.empty() || below == 0.0 ? not_known : values[order.back()];  // of a sum in another order
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
    require_points(positions, vertex_area_m2_.size(), "positions");
    require_points(reference, vertex_area_m2_.size(), "reference");
    Weighted apart_m, turned_deg;
    for (Eigen::Index v = 0; v < vertex_area_m2_.size(); ++v)
        if (vertex_area_m2_(v) > 0.0 && !left_out[v]) apart_m.add((positions.row(v) - reference.row(v)).norm(), vertex_area_m2_(v));
    for (Eigen::Index face = 0; face < skin_.rows(); ++face)
        if (!left_out[skin_(face, 0)] && !left_out[skin_(face, 1)] && !left_out[skin_(face, 2)])
            turned_deg.add(angle_deg(area_vector(positions, skin_, face), area_vector(reference, skin_, face)), area_m2_(face));
    const double rms_m = std::sqrt(apart_m.mean_of([](double value) { return value * value; })),
                 to_mm = 1e3 * compared_height_m / extent_m_;
    return {.rms_mm = to_mm * rms_m,
            .p95_mm = to_mm * weighted_quantile(apart_m.values, apart_m.weights, most),
            .largest_mm = to_mm * weighted_quantile(apart_m.values, apart_m.weights, 1.0),
            .rms_pct = 100.0 * rms_m / diagonal_m_,
            .normals_mean_deg = turned_deg.mean_of([](double value) { return value; }),
            .normals_p95_deg = weighted_quantile(turned_deg.values, turned_deg.weights, most)};
}

}  // namespace analysis
