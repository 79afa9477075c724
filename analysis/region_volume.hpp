// How much volume each region of a body gains or loses. Regions are sets of tets without tets in common.
//   const std::vector<RegionVolume> changes = RegionRuler(mesh.rest, mesh.tets, region_of_tet).measure(positions);
#pragma once

#include "pbs/geometry/types.hpp"

#include <vector>

namespace analysis {

// Signed tet volumes; all 0 for a number that no tet has.
struct RegionVolume {
    double rest_m3 = 0.0;        // sum V0_t
    double change_m3 = 0.0;      // sum V_t - V0_t, signed
    double abs_change_m3 = 0.0;  // sum |V_t - V0_t|
};

// Regions are numbered from 0 up to the highest.
class RegionRuler {
public:
    // region: of each tet, 0 or more; -1: in none, #T. Throws InputError unless there is one for each tet.
    RegionRuler(const pbs::Positions& rest, const pbs::Tets& tets, const std::vector<int>& region);

    std::vector<RegionVolume> measure(const pbs::Positions& positions) const;  // by region; [m], #V x 3, not checked
    double rest_volume_m3() const { return rest_volumes_.sum(); }              // of all tets, those in no region too

private:
    pbs::Tets tets_;
    Eigen::VectorXd rest_volumes_;
    std::vector<int> region_;
    std::size_t regions_ = 0;
};

}  // namespace analysis
