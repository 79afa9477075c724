// Other people's readers on damaged files: assimp ends the process on one damaged .ply in two, VTK and Gmsh on rarer ones, and all three
// may ask for memory or time without end. They run in a child process, silent, with a limit on both; what they read comes back through a
// pipe, and whatever becomes of the child, the caller gets a mesh or an InputError.
#pragma once

#include "pbs/geometry/types.hpp"

#include <functional>
#include <string>

namespace pbs {

struct IndexedPoints {
    Positions points;                                                           // [m], #V x 3
    Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> cells;  // vertex indices, #C x corners
};

// read(path) in a child process; its exceptions come back as InputErrors.
IndexedPoints read_guarded(const std::string& path, const std::function<IndexedPoints(const std::string&)>& read);

}  // namespace pbs
