// The volume a closed triangle surface encloses: what the render surface embedded in the tets keeps or loses.
//   const double change_pct = surface_volume_change_pct(rest_points, posed_points, triangles);
#pragma once

#include "pbs/geometry/types.hpp"

namespace analysis {

// Divergence theorem: sum of (a x b) . c / 6 over the triangles [m^3], positive when they face outward. InputError unless the surface is
// closed and oriented (each edge is run through as often one way as the other). Where it crosses itself, parts count by their winding
// number.
double enclosed_volume(const pbs::Positions& points, const pbs::Triangles& triangles);

// The surface of many frames: what does not change is checked and measured once.
class SurfaceVolume {
public:
    SurfaceVolume(const pbs::Positions& rest, const pbs::Triangles& triangles);  // InputError where V0 is not positive
    double change_pct(const pbs::Positions& posed) const;  // 100 (V - V0) / V0; InputError for another number of points

private:
    pbs::Triangles triangles_;
    Eigen::Index points_ = 0;
    double rest_volume_ = 0.0;
};

// The same for one frame.
double surface_volume_change_pct(const pbs::Positions& rest, const pbs::Positions& posed, const pbs::Triangles& triangles);

}  // namespace analysis
