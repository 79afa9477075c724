#include "analysis/metrics/error_norms.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/statistics/statistics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace analysis {
namespace {

void require_consistent(const ErrorDomain& domain)
{
    const auto vertices = static_cast<std::size_t>(domain.rest.rows());
    if (!domain.prescribed.empty() && domain.prescribed.size() != vertices)
        throw pbs::InputError("", 0, "entries of prescribed", std::to_string(domain.prescribed.size()),
                              fmt::format("expected {}", vertices));
    if (!domain.blended.empty() && domain.bone_distance_m.size() != domain.rest.rows())
        throw pbs::InputError("", 0, "bone distances", std::to_string(domain.bone_distance_m.size()), fmt::format("expected {}", vertices));
    for (int vertex : domain.blended)
        if (vertex < 0 || vertex >= domain.rest.rows())
            throw pbs::InputError("", 0, "blended vertex", std::to_string(vertex), fmt::format("expected 0 <= vertex < {}", vertices));
}

// The mean, weighted by mass, of one value per vertex over some vertices.
template <typename Value>
double weighted_mean(const std::vector<int>& vertices, const Eigen::VectorXd& mass, Value value)
{
    CompensatedSum sum, total;
    for (int vertex : vertices) {
        sum += mass(vertex) * value(vertex);
        total += mass(vertex);
    }
    return total.value() > 0.0 ? sum.value() / total.value() : not_known;
}

// Columns: the three edges from the tet's first vertex.
Eigen::Matrix3d edge_matrix(const pbs::Positions& positions, const pbs::Tets& tets, Eigen::Index t)
{
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = positions.row(tets(t, k + 1)) - positions.row(tets(t, 0));
    return edges;
}

void require_entries(const std::vector<bool>& vertices, Eigen::Index expected)
{
    if (static_cast<Eigen::Index>(vertices.size()) != expected)
        throw pbs::InputError("", 0, "marked vertices", std::to_string(vertices.size()), fmt::format("expected {}", expected));
}

std::vector<int> without(const std::vector<int>& vertices, const std::vector<bool>& left_out)
{
    std::vector<int> rest;
    std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(rest), [&](int vertex) { return !left_out[vertex]; });
    return rest;
}

}  // namespace

ErrorMetrics::ErrorMetrics(const ErrorDomain& domain)
{
    checked_rest_volumes(domain.rest, domain.tets);
    require_consistent(domain);
    mass_ = pbs::lumped_volumes(domain.rest, domain.tets);
    diagonal_m_ = (domain.rest.colwise().maxCoeff() - domain.rest.colwise().minCoeff()).norm();
    const auto is_free = [&](int vertex) { return domain.prescribed.empty() || !domain.prescribed[vertex]; };
    for (int vertex = 0; vertex < domain.rest.rows(); ++vertex)
        if (is_free(vertex)) free_.push_back(vertex);
    for (int vertex : domain.blended)
        if (is_free(vertex)) blended_.push_back(vertex);
    bone_distance_m_ = domain.bone_distance_m;
}

ErrorNorms ErrorMetrics::measure(const pbs::Positions& positions, const pbs::Positions& reference) const
{
    return measure(positions, reference, std::vector<bool>(mass_.size(), false));
}

ErrorNorms ErrorMetrics::measure(const pbs::Positions& positions, const pbs::Positions& reference, const std::vector<bool>& left_out) const
{
    require_points(positions, mass_.size(), "the frame");
    require_points(reference, mass_.size(), "the reference");
    require_entries(left_out, mass_.size());
    const std::vector<int> free = without(free_, left_out), blended = without(blended_, left_out);
    const auto square = [&](int vertex) { return (positions.row(vertex) - reference.row(vertex)).squaredNorm(); };
    const double bone_distance_m = weighted_mean(blended, mass_, [&](int vertex) { return bone_distance_m_(vertex); });
    ErrorNorms error;
    error.l2_pct = 100.0 * std::sqrt(weighted_mean(free, mass_, square)) / diagonal_m_;
    error.joint_pct = 100.0 * std::sqrt(weighted_mean(blended, mass_, square)) / bone_distance_m;
    double largest = free.empty() ? not_known : 0.0;
    for (int vertex : free)
        if (const double s = square(vertex); std::isnan(s) || s > largest) largest = s;  // a NaN is kept
    error.linf_m = std::sqrt(largest);
    return error;
}

double ErrorMetrics::share_pct(const std::vector<bool>& vertices) const
{
    require_entries(vertices, mass_.size());
    CompensatedSum sum, total;
    for (Eigen::Index v = 0; v < mass_.size(); ++v) {
        total += mass_(v);
        if (vertices[v]) sum += mass_(v);
    }
    return 100.0 * sum.value() / total.value();
}

double error_h1_pct(const pbs::Positions& rest, const pbs::Tets& tets, const pbs::Positions& positions, const pbs::Positions& reference)
{
    const Eigen::VectorXd volumes = checked_rest_volumes(rest, tets);
    require_points(positions, rest.rows(), "the frame");
    require_points(reference, rest.rows(), "the reference");
    const pbs::Positions difference = positions - reference;
    CompensatedSum sum, total;
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
        const Eigen::Matrix3d gradient = edge_matrix(difference, tets, t) * edge_matrix(rest, tets, t).inverse();  // F - Fref
        sum += volumes(t) * gradient.squaredNorm();
        total += volumes(t);
    }
    return 100.0 * std::sqrt(sum.value() / total.value());
}

}  // namespace analysis
