// The closed shells of a triangle surface, as the bodies, eyes and teeth of a character are, and the volume that each
// encloses.
//   const ClosedShells shells(rest.points, rest.triangles);
//   const Eigen::VectorXd change_m3 = shells.volumes(posed) - shells.volumes(rest.points);
// Files repeat points along seams of texture or of normals. Such points are joined at rest: those at the same place, to
// the rounding of single precision, at open edges alone. Bodies that touch each other stay apart. A shell is what
// shared edges join. It is closed if its triangles pass each edge equally often in both directions. An open shell can
// be closed by caps over its holes, as a body without what its clothes hide. A cap is the fan of a hole's edges about
// the mean of its points. Where the caps are not small, as on a sheet, the shell stays open.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <vector>

namespace analysis {

// How a shell counts.
enum class ShellRole {
    body,    // outermost; its volume is added
    cavity,  // closed, inside a body and facing inwards: its volume is negative, so that the sum is that of the flesh
    nested,  // closed, inside a body and facing outwards, as an eyeball in a head: its volume is added
    flat,    // closed without a volume, as a sheet with two sides: excluded
    copy,    // at the place of another one, as the back faces that some exporters add: excluded
    open     // excluded
};

enum class Holes { leave_open, cap };

struct Shell {
    ShellRole role = ShellRole::open;
    pbs::Triangles triangles;               // by joined points, #F of the shell x 3
    double area_m2 = 0.0, volume_m3 = 0.0;  // at rest; the volume is that of a closed shell, negative of a cavity
    int inside = -1;                        // the smallest shell around it, an index into all(); -1: none
    int turned = 0;      // triangles that were turned, against most of the shell or because it was inside out
    int copies = 0;      // triangles with the points of another one, left out
    int open_edges = 0;  // edges that are not passed equally often in both directions; 0 of a closed shell
    pbs::DirectedEdge first_open_edge = {};  // the smallest, if there is one
    // the points around each hole that is capped, against the direction of the triangles there
    std::vector<std::vector<int>> caps;
};

class ClosedShells {
public:
    // rest: [m], #P x 3; indices are in range (unchecked). Triangles that joining makes a line or a point are left out.
    ClosedShells(const pbs::Positions& rest, const pbs::Triangles& triangles, Holes holes = Holes::leave_open);

    const std::vector<Shell>& all() const { return shells_; }  // in the order of their first triangles
    // the shells that enclose a volume, indices into all()
    const std::vector<int>& counted() const { return counted_; }
    const pbs::Triangles& triangles() const { return triangles_; }  // of the counted shells, #F x 3
    // signed [m^3], one per counted shell; points: #P x 3
    Eigen::VectorXd volumes(const pbs::Positions& points) const;
    // between points that were joined at rest; 0 without any
    double largest_gap_m(const pbs::Positions& points) const;
    // By how much the change of the volumes from rest [m^3] may differ because the surface in the holes is not known,
    // if that surface moves with the rim of its hole. Where the rim moves rigidly, it then encloses the same volume;
    // otherwise its points move by at most as much more as those of the rim do. The bound is the cap's area times the
    // largest distance of the rim from its best rigid motion.
    double cap_bound_m3(const pbs::Positions& points) const;
    double counted_share() const;  // of the surface's area that encloses a volume, 0 to 1

private:
    pbs::Positions rest_;      // #P x 3
    std::vector<int> joined_;  // the point that stands for each point, #P
    std::vector<Shell> shells_;
    std::vector<int> counted_;
    pbs::Triangles triangles_;
};

}  // namespace analysis
