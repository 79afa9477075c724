// Cross-sections of a body: the exact area that a plane cuts out of tets, and the narrowest and widest places along its
// limbs relative to rest.
//   // smallest_ratio 0.2: a candy wrapper
//   const SectionExtremes sections = section_extremes(rest, positions, tets, stations);
// Every layer counts: flesh that folds over the plane, or crosses it twice, is counted once per layer, and an inverted
// tet like any other.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace analysis {

// A plane through a point; the side of the normal is above it.
struct Plane {
    pbs::Vec3 point;   // [m]
    pbs::Vec3 normal;  // any length except zero
};

// The area [m^2] that the plane cuts out of the chosen tets (indices into #T). A face that lies in the plane counts for
// the tet on the normal's side, so that neighbours never count it twice.
double cross_section_area(const pbs::Positions& positions, const pbs::Tets& tets, const std::vector<int>& chosen,
                          const Plane& plane);

// A place along a limb: the same material plane at rest and in the pose, and the tets of that limb. Tets of another
// limb that the plane also meets are not in the list.
struct SectionStation {
    Plane rest, posed;          // with normals of any length except zero
    std::vector<int> tets;      // indices into #T
    double rest_area_m2 = 0.0;  // area of its tets in the plane at rest; 0: it is measured
};

// Without stations, the extreme ratios are 1.
struct SectionExtremes {
    // one per station: area in the pose, and its ratio to the area at rest
    std::vector<double> area_m2, ratio;
    int smallest = -1, largest = -1;                   // the stations of the extreme ratios; -1 without stations
    double smallest_ratio = 1.0, largest_ratio = 1.0;  // the ratios of those stations
};

// InputError for a station whose plane misses its tets at rest, whose normal is zero or whose tets are out of range,
// and for positions whose number differs from that of rest.
SectionExtremes section_extremes(const pbs::Positions& rest, const pbs::Positions& positions, const pbs::Tets& tets,
                                 const std::vector<SectionStation>& stations);

// The thickness of a limb in a plane: area and radii of the outline that the plane cuts out of its skin.
//   const pbs::Positions* outline = enclosing_outline(outlines, {axis_point, axis_direction});
//   const OutlineSize size = outline_size(*outline);   // size.smallest_radius_m near zero: a candy wrapper
// Outlines are closed lines in a plane, points [m], #P x 3, the first not repeated at its end.
// Radii are distances from the centroid of the outline (weighted by length), so that flesh that is displaced as a whole
// does not count as thinner.
struct OutlineSize {
    double area_m2 = 0.0;  // enclosed area; where the outline crosses itself, parts that run clockwise are subtracted
    double smallest_radius_m = 0.0, largest_radius_m = 0.0;  // to the nearest point of a side; to the farthest corner
};
OutlineSize outline_size(const pbs::Positions& outline);  // all 0 without points

// How many times the outline winds around the plane's point; 0: the point lies outside.
int winding_number(const pbs::Positions& outline, const Plane& plane);

// The outline of the limb whose axis meets the plane in the plane's point: the tightest of the outlines that enclose
// that point or, if none does (a collapsed limb), the nearest one. Null without outlines.
const pbs::Positions* enclosing_outline(const std::vector<pbs::Positions>& outlines, const Plane& plane);

// Which part of the skin an outline consists of. A plane through an arm that lies in the trunk cuts the skin of both,
// and the two may form one outline.
//   share_of_outline(outline, plane, positions, skin, of_the_arm);   // 0.1: most of the outline belongs to the trunk
// The share of the length of an outline, cut out of the skin by the plane, that lies on edges whose nearer vertex is
// one of `chosen`, #V. 1 for an outline without length.
double share_of_outline(const pbs::Positions& outline, const Plane& plane, const pbs::Positions& positions,
                        const pbs::Triangles& skin, const std::vector<bool>& chosen);

}  // namespace analysis
