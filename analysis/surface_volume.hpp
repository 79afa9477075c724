// The volume that a closed triangle surface encloses, and how much of it the render surface embedded in the tets gains or loses.
//   const double change_pct = surface_volume_change_pct(rest_points, posed_points, triangles);
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <optional>

namespace analysis {

// Divergence theorem: the sum of (a x b) . c / 6 over the triangles [m^3], positive when they face outward. InputError unless the surface
// is closed and oriented (each edge occurs equally often in both directions). Where the surface crosses itself, parts count by their
// winding number.
double enclosed_volume(const pbs::Positions& points, const pbs::Triangles& triangles);

// The surface of many frames: what does not change is checked and measured only once.
class SurfaceVolume {
public:
    SurfaceVolume(const pbs::Positions& rest, const pbs::Triangles& triangles);  // InputError unless V0 is positive
    double change_pct(const pbs::Positions& posed) const;  // 100 (V - V0) / V0; InputError for a different number of points

private:
    pbs::Triangles triangles_;
    Eigen::Index points_ = 0;
    double rest_volume_ = 0.0;
};

// For the surface of any model: points at the same place at rest are one point, as along texture seams. Empty if the surface is open or
// encloses no positive volume.
std::optional<SurfaceVolume> surface_volume_of(const pbs::Positions& rest, const pbs::Triangles& triangles);

// The same for a single frame.
double surface_volume_change_pct(const pbs::Positions& rest, const pbs::Positions& posed, const pbs::Triangles& triangles);

}  // namespace analysis
