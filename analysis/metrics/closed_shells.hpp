// The closed shells of a triangle surface, such as the body, the eyes and the teeth of a character, and the volume that
// each of them encloses.
//   const ClosedShells shells(rest.points, rest.triangles);
//   const Eigen::VectorXd change_m3 = shells.volumes(posed) - shells.volumes(rest.points);
// A shell consists of the triangles that are connected by shared edges. It is closed if its triangles pass each edge
// equally often in both directions.
//
// Files repeat points along seams of texture or of normals. Points of open edges that are at the same place at rest, to
// the rounding of single precision, are therefore joined. Other points are not, so that bodies that touch each other
// stay apart.
//
// With Holes::cap, an open shell is closed by caps over its holes. A body that lacks what its clothes hide is an
// example. A cap is the fan of the hole's edges about the mean of its points. A shell with caps that are not small,
// such as a sheet, stays open.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <vector>

namespace analysis {

// Whether and how a shell counts. The shells that count are those that enclose a volume.
enum class ShellRole {
    body,    // counts: it is closed and inside no other shell
    cavity,  // counts: it faces inwards inside a body; its volume is negative, so that the sum is that of the flesh
    nested,  // counts: it faces outwards inside a body, as an eyeball in a head
    flat,    // does not count: it is closed without a volume, as a sheet with two sides
    copy,    // does not count: it is at the place of another one, as the back faces that some exporters add
    open     // does not count
};

enum class Holes { leave_open, cap };

struct Shell {
    ShellRole role = ShellRole::open;
    pbs::Triangles triangles;  // by joined points, #F of the shell x 3
    double area_m2 = 0.0;      // at rest
    double volume_m3 = 0.0;    // at rest; 0 if the shell stays open, negative for a cavity
    int inside = -1;           // the smallest shell around it, an index into all(); -1: none
    int turned = 0;      // triangles that were turned, since they were against most others or the shell was inside out
    int copies = 0;      // triangles that were left out, since another one has the same points
    int open_edges = 0;  // edges that are not passed equally often in both directions; 0 of a closed shell
    pbs::DirectedEdge first_open_edge = {};  // the smallest, if there is one
    // the points around each hole that is capped, against the direction of the triangles there
    std::vector<std::vector<int>> caps;
};

class ClosedShells {
public:
    // rest: [m], #P x 3. triangles: #F x 3; the indices are not checked. Triangles that become a line or a point when
    // points are joined are left out.
    ClosedShells(const pbs::Positions& rest, const pbs::Triangles& triangles, Holes holes = Holes::leave_open);

    const std::vector<Shell>& all() const { return shells_; }  // in the order of their first triangles
    // the shells that enclose a volume, indices into all()
    const std::vector<int>& counted() const { return counted_; }
    const pbs::Triangles& triangles() const { return triangles_; }  // of the counted shells, #F x 3
    // The signed volume of each counted shell [m^3]. points: [m], #P x 3, as for the functions below.
    Eigen::VectorXd volumes(const pbs::Positions& points) const;
    // The largest distance between points that were joined at rest; 0 if there are none.
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
