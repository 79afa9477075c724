// Tets with fields as a .vtu in plain text: VTK's XML with arrays in ASCII, which any language reads without a library.
//   analysis::write_text_atomically("limb.vtu",
//                                   plain_vtu(mesh, {.of_points = {{"displacement", displacement}}, .facts =
//                                   {{"own_error_pct", 0.4}}}));
//   const PlainFields fields = read_plain_fields("limb.vtu");
// Other files are read by experiments/meshes/mesh_io.hpp, which reads the points and tets of these, too.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <map>
#include <string>
#include <vector>

namespace experiments {

struct PlainFields {
    std::map<std::string, Eigen::MatrixXd> of_points = {};          // #V x components
    std::map<std::string, std::vector<int>> labels_of_points = {};  // #V
    std::map<std::string, std::vector<int>> labels_of_tets = {};    // #T
    std::map<std::string, double> facts = {};                       // of the whole, in <FieldData>
};

// The text of the file. Its numbers read back to the bit.
std::string plain_vtu(const pbs::TetMesh& mesh, const PlainFields& fields);

// The fields of points, labels among them as #V x 1, and the facts. None of a file of another format, and none of an
// array that is not in plain text. InputError for an array with a text that is no finite number, or whose length is no
// multiple of the number of points.
PlainFields read_plain_fields(const std::string& path);

}  // namespace experiments
