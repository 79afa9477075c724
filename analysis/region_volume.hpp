// The volume that each region of a body gains or loses. Regions are disjoint sets of tets.
//   const std::vector<RegionVolume> changes = RegionMetrics(mesh.rest, mesh.tets, region_of_tet).measure(positions);
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace analysis {

// Computed from signed tet volumes; all members are 0 for a region without tets.
struct RegionVolume {
    double rest_m3 = 0.0;        // sum V0_t
    double change_m3 = 0.0;      // sum V_t - V0_t, signed
    double abs_change_m3 = 0.0;  // sum |V_t - V0_t|
};

// Regions are numbered from 0 to the highest number in use.
class RegionMetrics {
public:
    // region: one entry per tet, #T; 0 or more, or -1 for a tet in no region. InputError unless there is one entry for each tet.
    RegionMetrics(const pbs::Positions& rest, const pbs::Tets& tets, const std::vector<int>& region);

    std::vector<RegionVolume> measure(const pbs::Positions& positions) const;  // one per region; positions [m], #V x 3, not checked
    double rest_volume_m3() const { return rest_volumes_.sum(); }              // all tets, including those in no region

private:
    pbs::Tets tets_;
    Eigen::VectorXd rest_volumes_;
    std::vector<int> region_;
    std::size_t regions_ = 0;
};

}  // namespace analysis
