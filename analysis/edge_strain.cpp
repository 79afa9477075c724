#include "analysis/edge_strain.hpp"

#include "analysis/rest_mesh_checks.hpp"
#include "analysis/statistics.hpp"

#include <cmath>
#include <vector>

namespace analysis {
namespace {

std::vector<double> edge_ratios(const pbs::Positions& rest, const pbs::Edges& edges, const pbs::Positions& positions)
{
    require_points(positions, rest.rows(), "the frame");
    const auto length = [&](const pbs::Positions& x, Eigen::Index e) { return (x.row(edges(e, 0)) - x.row(edges(e, 1))).norm(); };
    std::vector<double> ratios;
    for (Eigen::Index e = 0; e < edges.rows(); ++e) ratios.push_back(length(positions, e) / length(rest, e));
    return ratios;
}

}  // namespace

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

}  // namespace analysis
