#include "analysis/metrics/error_norms.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/statistics/statistics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

namespace analysis {
namespace {

void require_consistent(const ErrorDomain& domain)
{
    const auto vertices = static_cast<std::size_t>(domain.rest.rows());
    if (!domain.prescribed.empty() && domain.prescribed.size() != vertices)
        throw pbs::InputError("", 0, "entries of prescribed", std::to_string(domain.prescribed.size()),
                              fmt::format("expected {}", vertices));
    if (!domain.blended.empty() && domain.bone_distance_m.size() != domain.rest.rows())
        throw pbs::InputError("", 0, "bone distances", std::to_string(domain.bone_distance_m.size()),
                              fmt::format("expected {}", vertices));
    for (int vertex : domain.blended)
        if (vertex < 0 || vertex >= domain.rest.rows())
            throw pbs::InputError("", 0, "blended vertex", std::to_string(vertex),
                                  fmt::format("expected 0 <= vertex < {}", vertices));
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

std::vector<int> without(const std::vector<int>& vertices, const std::vector<bool>& left_out)
{
    std::vector<int> rest;
    std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(rest),
                 [&](int vertex) { return !left_out[vertex]; });
    return rest;
}

using pbs::Positions;
using pbs::Vec3;

Vec3 point_of(const Positions& positions, int vertex)
{
    return positions.row(vertex);
}

// The signed angle between the normals of the triangles (first, second, left) and (second, first, right); zero where
// the skin is flat.
double dihedral_angle(const Positions& positions, int first, int second, int left, int right)
{
    const Vec3 a = point_of(positions, first), edge = point_of(positions, second) - a;
    const Vec3 normal = edge.cross(point_of(positions, left) - a), other = (point_of(positions, right) - a).cross(edge);
    if (!(edge.norm() > 0.0)) return 0.0;
    return std::atan2(normal.cross(other).dot(edge.normalized()), normal.dot(other));
}

template <std::size_t n>
bool all_near(const std::array<int, n>& vertices, const std::vector<bool>& near)
{
    return std::all_of(vertices.begin(), vertices.end(), [&](int v) { return near[v]; });
}

double rms(double weighted_squares, double weights)
{
    return weights > 0.0 ? std::sqrt(weighted_squares / weights) : 0.0;
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

ErrorNorms ErrorMetrics::measure(const pbs::Positions& positions, const pbs::Positions& reference,
                                 const std::vector<bool>& left_out) const
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

SmoothnessMetrics::SmoothnessMetrics(const Positions& rest, const pbs::Tets& tets, const std::vector<bool>& near)
    : rest_(rest), tets_(tets)
{
    checked_rest_volumes(rest, tets);
    if (static_cast<Eigen::Index>(near.size()) != rest.rows())
        throw pbs::InputError("", 0, "near", "", "expected one entry per vertex");
    find_inner_faces(near);
    find_skin_edges(near);
}

void SmoothnessMetrics::find_inner_faces(const std::vector<bool>& near)
{
    const std::vector<pbs::TetFace> faces = pbs::sorted_faces(tets_);
    std::map<std::array<int, 2>, InnerFace> in_file_order;  // by the second tet and its corner opposite to the face
    for (std::size_t f = 1; f < faces.size(); ++f) {
        const pbs::TetFace &face = faces[f], &before = faces[f - 1];
        if (face.sorted != before.sorted || !all_near(face.sorted, near)) continue;
        const auto& [a, b, c] = face.sorted;
        const double area_m2 = pbs::triangle_area(rest_.row(a), rest_.row(b), rest_.row(c));
        in_file_order[{face.tet, face.face}] = {before.tet, face.tet, area_m2};
    }
    for (const auto& [place, face] : in_file_order) faces_.push_back(face);
}

void SmoothnessMetrics::find_skin_edges(const std::vector<bool>& near)
{
    // directed edges of the outward triangles, and the vertex opposite to each
    std::map<std::array<int, 2>, int> left_of;
    const pbs::Triangles skin = pbs::boundary_of(tets_);
    for (const auto triangle : skin.rowwise())
        for (int i = 0; i < 3; ++i) left_of[{triangle(i), triangle((i + 1) % 3)}] = triangle((i + 2) % 3);
    for (const auto& [edge, left] : left_of) {
        const auto other = left_of.find({edge[1], edge[0]});
        if (edge[0] > edge[1] || other == left_of.end() || !all_near(edge, near)) continue;
        const double length_m = (point_of(rest_, edge[1]) - point_of(rest_, edge[0])).norm();
        const double angle_rad = dihedral_angle(rest_, edge[0], edge[1], left, other->second);
        edges_.push_back({edge[0], edge[1], left, other->second, length_m, angle_rad});
    }
}

Eigen::Matrix3d SmoothnessMetrics::green_strain(const Positions& positions, int tet) const
{
    const Eigen::Matrix3d f = edge_matrix(positions, tets_, tet) * edge_matrix(rest_, tets_, tet).inverse();
    return 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
}

Smoothness SmoothnessMetrics::measure(const Positions& positions) const
{
    require_points(positions, rest_.rows(), "the frame");
    double jumps = 0.0, area = 0.0, bends = 0.0, length = 0.0;
    for (const InnerFace& face : faces_) {
        jumps += face.area_m2 * (green_strain(positions, face.tet) - green_strain(positions, face.other)).squaredNorm();
        area += face.area_m2;
    }
    for (const SkinEdge& edge : edges_) {
        const double change =
            dihedral_angle(positions, edge.first, edge.second, edge.left, edge.right) - edge.angle_rad;
        bends += edge.length_m * std::pow(std::remainder(change, 2.0 * std::numbers::pi), 2);
        length += edge.length_m;
    }
    return {rms(jumps, area), rms(bends, length)};
}

}  // namespace analysis
