#include "analysis/metrics/frame_metrics.hpp"

#include "analysis/statistics/statistics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace analysis {

Eigen::VectorXd checked_rest_volumes(const pbs::Positions& rest, const pbs::Tets& tets)
{
    if (tets.rows() == 0) throw pbs::InputError("", 0, "tets", "0", "expected at least one tet");
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner)
            if (tets(t, corner) < 0 || tets(t, corner) >= rest.rows())
                throw pbs::InputError("", 0, fmt::format("tet {}", t), fmt::format("vertex {}", tets(t, corner)),
                                      fmt::format("expected 0 <= vertex < {}", rest.rows()));
    return pbs::positive_volumes(rest, tets);
}

void require_points(const pbs::Positions& positions, Eigen::Index vertices, const char* name)
{
    if (positions.rows() != vertices)
        throw pbs::InputError("", 0, fmt::format("points of {}", name), std::to_string(positions.rows()),
                              fmt::format("expected {} as in the rest mesh", vertices));
}

void require_entries(const std::vector<bool>& marked, Eigen::Index vertices)
{
    if (static_cast<Eigen::Index>(marked.size()) != vertices)
        throw pbs::InputError("", 0, "marked vertices", std::to_string(marked.size()),
                              fmt::format("expected {}", vertices));
}

namespace {

Eigen::VectorXd edge_lengths(const pbs::Positions& positions, const pbs::Edges& edges)
{
    Eigen::VectorXd lengths(edges.rows());
    for (Eigen::Index e = 0; e < edges.rows(); ++e)
        lengths(e) = (positions.row(edges(e, 0)) - positions.row(edges(e, 1))).norm();
    return lengths;
}

std::vector<double> edge_ratios(const pbs::Positions& rest, const pbs::Edges& edges, const pbs::Positions& positions)
{
    require_points(positions, rest.rows(), "the frame");
    const Eigen::VectorXd ratios = edge_lengths(positions, edges).cwiseQuotient(edge_lengths(rest, edges));
    return {ratios.begin(), ratios.end()};
}

void require_closed(const pbs::Positions& points, const pbs::Triangles& triangles)
{
    if (triangles.rows() == 0) throw pbs::InputError("", 0, "triangles", "0", "expected a closed surface");
    if (triangles.minCoeff() < 0 || triangles.maxCoeff() >= points.rows())
        throw pbs::InputError("", 0, "triangles", "", fmt::format("expected 0 <= vertex < {}", points.rows()));
    const auto edge = pbs::open_edge(triangles);
    if (!edge) return;
    throw pbs::InputError("", 0, "edge", fmt::format("{}-{}", edge->first, edge->second),
                          "expected a closed, oriented surface");
}

}  // namespace

MeshMetrics::MeshMetrics(const pbs::Positions& rest, const pbs::Tets& tets)
    : tets_(tets),
      rest_volumes_(checked_rest_volumes(rest, tets)),
      edges_(pbs::edges_of(tets)),
      rest_lengths_(edge_lengths(rest, edges_)),
      vertices_(rest.rows())
{
    CompensatedSum total;
    for (double volume : rest_volumes_) total += volume;
    rest_volume_ = total.value();
}

FrameMetrics MeshMetrics::measure(const pbs::Positions& positions) const
{
    require_points(positions, vertices_, "the frame");
    const Eigen::VectorXd volumes = pbs::tet_volumes(positions, tets_);
    FrameMetrics metrics;
    metrics.j_min = std::numeric_limits<double>::infinity();
    CompensatedSum change, abs_change;
    for (Eigen::Index t = 0; t < volumes.size(); ++t) {
        const double difference = volumes(t) - rest_volumes_(t), j = volumes(t) / rest_volumes_(t);
        change += difference;
        abs_change += std::abs(difference);
        if (!(volumes(t) > 0.0)) ++metrics.inverted_tets;
        if (std::isnan(j) || j < metrics.j_min) metrics.j_min = j;  // a NaN is kept
    }
    metrics.volume_change_pct = 100.0 * change.value() / rest_volume_;
    metrics.volume_abs_change_pct = 100.0 * abs_change.value() / rest_volume_;
    metrics.mean_abs_j_minus_1 = abs_change.value() / rest_volume_;  // V0_t |J_t - 1| = |V_t - V0_t|
    metrics.stretch_rms = stretch_rms(positions);
    return metrics;
}

Eigen::VectorXd MeshMetrics::volume_ratios(const pbs::Positions& positions) const
{
    require_points(positions, vertices_, "the frame");
    return pbs::tet_volumes(positions, tets_).cwiseQuotient(rest_volumes_);
}

double MeshMetrics::stretch_rms(const pbs::Positions& positions) const
{
    const Eigen::VectorXd lengths = edge_lengths(positions, edges_);
    CompensatedSum squares;
    for (Eigen::Index e = 0; e < lengths.size(); ++e) {
        const double stretch = lengths(e) / rest_lengths_(e) - 1.0;
        squares += stretch * stretch;
    }
    return std::sqrt(squares.value() / static_cast<double>(lengths.size()));
}

double bind_rms(const pbs::Positions& positions, const pbs::Positions& bind_points,
                const Eigen::VectorXd& bind_distance)
{
    require_points(bind_points, positions.rows(), "the bind constraints");
    CompensatedSum squares;
    for (Eigen::Index i = 0; i < positions.rows(); ++i) {
        const double residual = (positions.row(i) - bind_points.row(i)).norm() - bind_distance(i);
        squares += residual * residual;
    }
    return positions.rows() == 0 ? 0.0 : std::sqrt(squares.value() / static_cast<double>(positions.rows()));
}

double largest_edge_strain(const pbs::Positions& rest, const pbs::Edges& edges, const pbs::Positions& positions)
{
    double largest = 0.0;
    for (const double ratio : edge_ratios(rest, edges, positions)) {
        const double strain = std::abs(ratio - 1.0);
        if (std::isnan(strain) || strain > largest) largest = strain;  // a NaN is kept: no comparison with it is true
    }
    return largest;
}

double median_edge_ratio(const pbs::Positions& rest, const pbs::Edges& edges, const pbs::Positions& positions)
{
    return edges.rows() == 0 ? 1.0 : median(edge_ratios(rest, edges, positions));
}

RegionMetrics::RegionMetrics(const pbs::Positions& rest, const pbs::Tets& tets, const std::vector<int>& region)
    : tets_(tets), rest_volumes_(pbs::tet_volumes(rest, tets)), region_(region)
{
    if (static_cast<Eigen::Index>(region.size()) != tets.rows())
        throw pbs::InputError("", 0, "regions", std::to_string(region.size()), "expected one for each of the tets");
    for (const int r : region) regions_ = std::max(regions_, static_cast<std::size_t>(r + 1));
}

std::vector<RegionVolume> RegionMetrics::measure(const pbs::Positions& positions) const
{
    const Eigen::VectorXd volumes = pbs::tet_volumes(positions, tets_);
    std::vector<RegionVolume> changes(regions_);
    for (std::size_t t = 0; t < region_.size(); ++t) {
        if (region_[t] < 0) continue;
        RegionVolume& change = changes[region_[t]];
        const auto tet = static_cast<Eigen::Index>(t);
        change.rest_m3 += rest_volumes_(tet);
        change.change_m3 += volumes(tet) - rest_volumes_(tet);
        change.abs_change_m3 += std::abs(volumes(tet) - rest_volumes_(tet));
    }
    return changes;
}

double signed_volume(const pbs::Positions& points, const pbs::Triangles& triangles)
{
    // a nearby origin, so that a surface far from zero loses no digits
    const pbs::Vec3 origin = points.row(triangles(0, 0));
    CompensatedSum volume;
    for (Eigen::Index f = 0; f < triangles.rows(); ++f)
        volume += pbs::tet_volume(origin, points.row(triangles(f, 0)), points.row(triangles(f, 1)),
                                  points.row(triangles(f, 2)));
    return volume.value();
}

double enclosed_volume(const pbs::Positions& points, const pbs::Triangles& triangles)
{
    require_closed(points, triangles);
    return signed_volume(points, triangles);
}

SurfaceVolume::SurfaceVolume(const pbs::Positions& rest, const pbs::Triangles& triangles)
    : triangles_(triangles), points_(rest.rows()), rest_volume_(enclosed_volume(rest, triangles))
{
    if (!(rest_volume_ > 0.0))
        throw pbs::InputError("", 0, "enclosed rest volume", fmt::format("{} m^3", rest_volume_),
                              "expected > 0: triangles face outward");
}

double SurfaceVolume::change_pct(const pbs::Positions& posed) const
{
    require_points(posed, points_, "the posed surface");
    return 100.0 * (signed_volume(posed, triangles_) - rest_volume_) / rest_volume_;
}

std::optional<SurfaceVolume> surface_volume_of(const pbs::Positions& rest, const pbs::Triangles& triangles)
{
    const pbs::Triangles joined = pbs::joined_triangles(rest, triangles);
    if (!pbs::is_closed(joined) || !(signed_volume(rest, joined) > 0.0)) return std::nullopt;
    return SurfaceVolume(rest, joined);
}

double surface_volume_change_pct(const pbs::Positions& rest, const pbs::Positions& posed,
                                 const pbs::Triangles& triangles)
{
    return SurfaceVolume(rest, triangles).change_pct(posed);
}

}  // namespace analysis
