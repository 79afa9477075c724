// Constraints in groups, which a lane projects one after the other before it stores their vertices (../../packed/batch.hpp).
// `ordered`: groups of one. `grouped`: edges as the six of a tet, the three of a triangle, two that share a vertex, or alone; tets as fans
// of three or two round an edge, or alone. Grouping changes the order of projection and so, a little, what 24 iterations give.
#pragma once

#include "pbs/geometry/types.hpp"
#include "pbs/packed/batch.hpp"

#include <array>
#include <vector>

namespace pbs {

inline constexpr int largest_group = 6;  // of vertices and of constraints

// The constraints that one lane projects.
struct ConstraintGroup {
    GroupKind kind;                             // says how many entries of the arrays count
    std::array<int, largest_group> vertex;      // as GroupShape<kind> counts them
    std::array<int, largest_group> constraint;  // index into the class, as GroupShape<kind>::joins; -1: there is none
};

int vertices_of(GroupKind kind);     // GroupShape<kind>::vertices
int constraints_of(GroupKind kind);  // GroupShape<kind>::constraints

// edges: vertices of each stretch constraint. tets: of each volume constraint.
std::vector<ConstraintGroup> single_edges(const std::vector<std::array<int, 2>>& edges);
std::vector<ConstraintGroup> single_tets(const std::vector<std::array<int, 4>>& tets);  // one group each, in the order given

// mesh_tets: any tets whose edges may be grouped, constrained or not.
std::vector<ConstraintGroup> grouped_edges(const std::vector<std::array<int, 2>>& edges, const Tets& mesh_tets);
std::vector<ConstraintGroup> grouped_tets(const std::vector<std::array<int, 4>>& tets);  // every tet in one group

}  // namespace pbs
