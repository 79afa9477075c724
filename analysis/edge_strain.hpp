// The edge that is stretched or compressed most: largest |l / l0 - 1| over the edges of a tet mesh.
//   double strain = largest_edge_strain(mesh.rest, pbs::edges_of(mesh.tets), positions);
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace analysis {

// 0 without edges; NaN if a position is NaN. InputError for a frame with another number of points.
double largest_edge_strain(const pbs::Positions& rest, const pbs::Edges& edges, const pbs::Positions& positions);

// Median over the edges of l / l0. It is near 1 for any deformation of a body, and near a power of ten for a body in other units. 1 without
// edges. InputError as for largest_edge_strain.
double median_edge_ratio(const pbs::Positions& rest, const pbs::Edges& edges, const pbs::Positions& positions);

}  // namespace analysis
