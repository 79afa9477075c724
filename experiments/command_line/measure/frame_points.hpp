// The points of a frame from another program against those of the mesh at rest.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <string>
#include <vector>

namespace experiments {

// InputError unless the frame has as many points as the file of the rest mesh.
void require_as_many_points(const std::string& path, Eigen::Index points, Eigen::Index expected);

// InputError where the median edge has changed by the ratio of two units of length. Positions and rest: [m], #V x 3.
void require_same_units(const std::string& path, const pbs::Positions& rest, const pbs::Edges& edges,
                        const pbs::Positions& positions);

// Whether points are those of the rest mesh, to the rounding of single precision.
bool are_at_rest(const pbs::Positions& points, const pbs::Positions& rest);

// The shape that a frame states [m], #V x 3. Programs of finite elements write the points of the rest mesh and a vector
// of each point, by which ParaView warps them.
// - displacement empty: the points. InputError where they are those of the rest mesh while a vector of the points is
// not zero.
// - `none`: the points.
// - a name: rest + that vector, or three scalars that are named as its components (ux, u_x or u:0 for u, U1 for U, DX
// for D). InputError where the file lacks it, or where its points are not those of the rest mesh. points, rest: #V x 3;
// file_point: the file's number of each, #V.
pbs::Positions shape_of_frame(const std::string& path, const pbs::Positions& points, const pbs::Positions& rest,
                              const std::vector<int>& file_point, const std::string& displacement);

}  // namespace experiments
