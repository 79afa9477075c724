// Points and cells that a library reads in a child process (child_process.hpp) and sends through a pipe.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <functional>
#include <string>

namespace pbs {

// A mesh of one kind of cell, as a reader returns it: nothing is checked.
struct IndexedPoints {
    Positions points;                                                           // [m], #V x 3
    Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> cells;  // vertex indices, #C x corners
};

// read(path) in a child process; its exceptions come back as InputErrors. Indices are returned as the child sends them.
IndexedPoints read_guarded(const std::string& path, const std::function<IndexedPoints(const std::string&)>& read);

// The bytes sent through the pipe; an InputError that names the file where the bytes are not a whole mesh.
std::string packed(const IndexedPoints& mesh);
IndexedPoints unpacked_points(const std::string& bytes, const std::string& path);  // `path`: the file that errors name

}  // namespace pbs
