// Cross-sections of a body: the exact area of a plane's cut through tets, and the narrowest and widest place along its limbs against rest.
//   const SectionExtremes sections = section_extremes(rest, positions, tets, stations);   // smallest_ratio 0.2: a candy wrapper
// Every sheet counts: flesh that folds over the plane, or lies in it twice, is counted once a sheet, and an inverted tet like any other.
#pragma once

#include "pbs/geometry/types.hpp"

#include <vector>

namespace analysis {

// Through a point; what lies on the side of the normal is above.
struct Plane {
    pbs::Vec3 point;   // [m]
    pbs::Vec3 normal;  // of any length but zero
};

// Area [m^2] that the plane cuts out of the chosen tets (indices into #T). A face that lies in the plane counts for the tet on the
// normal's side, so that neighbours never count it twice.
double cross_section_area(const pbs::Positions& positions, const pbs::Tets& tets, const std::vector<int>& chosen, const Plane& plane);

// A place along a limb: the same material plane at rest and in the pose, and the tets of that limb (another limb that the plane also
// meets is left out by not being in the list).
struct SectionStation {
    Plane rest, posed;          // with normals of any length but zero
    std::vector<int> tets;      // indices into #T
    double rest_area_m2 = 0.0;  // of its tets in the plane at rest; 0: measured
};

// Without stations the ratios are 1.
struct SectionExtremes {
    std::vector<double> area_m2, ratio;                // one a station: in the pose, and over rest
    int smallest = -1, largest = -1;                   // stations of the extreme ratios; -1 without stations
    double smallest_ratio = 1.0, largest_ratio = 1.0;  // of those stations
};

// InputError for a station whose plane misses its tets at rest, whose normal is zero or whose tets are out of range, and for positions of
// another number than rest.
SectionExtremes section_extremes(const pbs::Positions& rest, const pbs::Positions& positions, const pbs::Tets& tets,
                                 const std::vector<SectionStation>& stations);

}  // namespace analysis
