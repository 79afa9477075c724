// The order of projection in the code published by the paper's first author (author_solver.hpp). Its constraints are listed as volume by
// tet, bind by vertex, and stretch by edge. Each one joins the first group in which no constraint of any kind has one of its vertices. The
// groups are projected in turn; within a group the order does not matter, to the bit.
//   for (const AuthorGroup& group : author_groups(mesh, binding)) project_all(group);
#pragma once

#include "pbs/author/author_constraints.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/weights.hpp"

namespace pbs {

// Constraints that share no vertex.
struct AuthorGroup {
    std::vector<AuthorVolume> volume;
    std::vector<AuthorBind> bind;
    std::vector<AuthorStretch> stretch;
};

// Each edge once, as it first appears when the tets list theirs as 01, 02, 03, 12, 13, 23, #E x 2.
Edges edges_by_appearance(const Tets& tets);

// mesh: indices in range (unchecked). binding: of its vertices.
std::vector<AuthorGroup> author_groups(const TetMesh& mesh, const BoneBinding& binding);

}  // namespace pbs
