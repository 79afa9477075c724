#include "analysis/metrics/frame_metrics.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace analysis {

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

}  // namespace analysis
