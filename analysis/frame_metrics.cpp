#include "analysis/metrics/frame_metrics.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <cmath>
#include <limits>

namespace analysis {
namespace {

Eigen::VectorXd edge_lengths(const pbs::Positions& positions, const pbs::Edges& edges)
{
    Eigen::VectorXd lengths(edges.rows());
    for (Eigen::Index e = 0; e < edges.rows(); ++e) lengths(e) = (positions.row(edges(e, 0)) - positions.row(edges(e, 1))).norm();
    return lengths;
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

double bind_rms(const pbs::Positions& positions, const pbs::Positions& bind_points, const Eigen::VectorXd& bind_distance)
{
    require_points(bind_points, positions.rows(), "the bind constraints");
    CompensatedSum squares;
    for (Eigen::Index i = 0; i < positions.rows(); ++i) {
        const double residual = (positions.row(i) - bind_points.row(i)).norm() - bind_distance(i);
        squares += residual * residual;
    }
    return positions.rows() == 0 ? 0.0 : std::sqrt(squares.value() / static_cast<double>(positions.rows()));
}

}  // namespace analysis
