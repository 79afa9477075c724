// COLLADA files before assimp reads them: what assimp drops or applies otherwise than the format states is written so
// that assimp applies it, or refused.
//   const ColladaDocument document = read_collada_document("hero.dae");
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <map>
#include <string>
#include <vector>

namespace pbs {

struct ColladaDocument {
    std::string text;                       // the document in place of the file's; empty: the file is read as it is
    std::vector<std::string> remarks = {};  // what it leaves out
    // Where a geometry is farther from the origin than a hundred times its size: what is to be added to the points of
    // each geometry [file's units], by its id, since assimp reads in single precision; 0 for those that are near. The
    // document then states no unit.
    std::map<std::string, Vec3> origins = {};
    double unit_m = 1.0;  // of the points and nodes that assimp returns
};

// .dae, or a .zae archive with one such document; those of an archive with several are only checked. In place of
// - curves that are stepped or Bezier curves: linear ones with more keys, within 1e-6 of the range of the curve's
// values, 1e-5 s before a step
// - joint -1, the bind shape: a node at the origin of the scene, which no animation moves
// - a morph: the mesh or the skin from which it departs; its targets are a remark
// - a node of library_nodes that the scene instantiates once: the node itself
// - a controller of several skeletons: one for each, with joints of other names.
// InputErrors: a negative index of a polygon, which assimp takes for 0; a weight, of a skin that the scene uses, that
// is negative or not finite; a curve of another kind, or a Bezier curve of matrices; joints of two skeletons that are
// known by their ids; two geometries with one id. Text that is not XML is left to assimp.
ColladaDocument read_collada_document(const std::string& path);

}  // namespace pbs
