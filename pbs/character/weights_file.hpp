// Skinning weights from a file: CSV vertex,joint,weight.
#pragma once

#include "pbs/skinning/weights.hpp"

#include <string>

namespace pbs {

// vertices: #V of the mesh. Zero weights are left out. InputError by line where the header vertex,joint,weight is missing; a row has not
// three fields, a vertex from 0 to #V - 1, a joint of the skeleton (the nearest is named) and a weight in [0, 1]; a vertex names a joint
// twice, has no weight, or its weights do not sum to one within 1e-6.
Weights read_weights(const std::string& path, const Skeleton& skeleton, int vertices);

// `name` stands for the file in errors.
Weights parse_weights(const std::string& text, const std::string& name, const Skeleton& skeleton, int vertices);

// The same for tets of whose file vertices were left out or split: file_vertex is the file's number of each vertex, #V, below
// file_vertices. Only vertices that are in it need weights.
Weights parse_weights(const std::string& text, const std::string& name, const Skeleton& skeleton, int file_vertices,
                      const std::vector<int>& file_vertex);

}  // namespace pbs
