// Cross-sections of a body: the exact area that a plane cuts out of tets, and the narrowest and widest places along its limbs relative to
// rest.
//   const SectionExtremes sections = section_extremes(rest, positions, tets, stations);   // smallest_ratio 0.2: a candy wrapper
// Every layer counts: flesh that folds over the plane, or crosses it twice, is counted once per layer, and an inverted tet like any other.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace analysis {

// A plane through a point; the side of the normal is above it.
struct Plane {
    pbs::Vec3 point;   // [m]
    pbs::Vec3 normal;  // any length but zero
};

// The area [m^2] that the plane cuts out of the chosen tets (indices into #T). A face that lies in the plane counts for the tet on the
// normal's side, so that neighbours never count it twice.
double cross_section_area(const pbs::Positions& positions, const pbs::Tets& tets, const std::vector<int>& chosen, const Plane& plane);

// A place along a limb: the same material plane at rest and in the pose, and the tets of that limb. Tets of another limb that the plane
// also meets are not in the list.
struct SectionStation {
    Plane rest, posed;          // with normals of any length but zero
    std::vector<int> tets;      // indices into #T
    double rest_area_m2 = 0.0;  // area of its tets in the plane at rest; 0: it is measured
};

// Without stations, the extreme ratios are 1.
struct SectionExtremes {
    std::vector<double> area_m2, ratio;                // one per station: area in the pose, and its ratio to the area at rest
    int smallest = -1, largest = -1;                   // the stations of the extreme ratios; -1 without stations
    double smallest_ratio = 1.0, largest_ratio = 1.0;  // the ratios of those stations
};

// InputError for a station whose plane misses its tets at rest, whose normal is zero or whose tets are out of range, and for positions
// whose number differs from that of rest.
SectionExtremes section_extremes(const pbs::Positions& rest, const pbs::Positions& positions, const pbs::Tets& tets,
                                 const std::vector<SectionStation>& stations);

}  // namespace analysis
