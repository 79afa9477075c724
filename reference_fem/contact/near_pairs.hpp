// The pairs of a surface's nodes and triangles, and of its edges, that can come within a range, for contact.
//   const NearPairs near(space, range_m);
//   for (const NearPair& pair : near.at(displacement))
//       closest_points(pair.kind, near.points_of(near.nodes_of(pair), displacement));
#pragma once

#include "reference_fem/assembly.hpp"
#include "reference_fem/contact/closest_points.hpp"

#include <array>
#include <vector>

namespace reference_fem {

// The surface by which flesh touches: the boundary faces of P1; those of P2 cut into four flat triangles over their six
// nodes.
struct ContactSurface {
    std::vector<int> nodes;                     // ascending
    std::vector<std::array<int, 2>> edges;      // of nodes, sorted
    std::vector<std::array<int, 3>> triangles;  // of nodes, oriented outward
    Eigen::VectorXd node_area;      // [m^2], #nodes of the space: a third of the triangles around a node; 0 inside
    std::vector<double> edge_area;  // [m^2], #edges: a third of the two triangles at an edge
};
ContactSurface contact_surface(const SimplexSpace& space);

// A node and a triangle, or two edges, by their places in the surface.
struct NearPair {
    PairKind kind;
    int first, second;        // #space's node and triangle, or two edges, the lower one first
    double range_m = 0.0;     // below it the pair presses
    double distance_m = 0.0;  // where the search was
};

// A search finds all pairs that can come within the range on a step. It is repeated when the surface has left its
// surroundings, so that no result depends on it. The range of a pair is at most half of its distance at rest, so that
// nothing presses at rest; that of edges is half of it. Pairs with a common node, and those that touch at rest, are
// left out.
class NearPairs {
public:
    NearPairs(const SimplexSpace& space, double range_m);  // the space may go

    const ContactSurface& surface() const { return surface_; }

    // displacement, step [m], #dofs.
    const std::vector<NearPair>& at(const Eigen::VectorXd& displacement) const;                   // sorted
    double largest_step(const Eigen::VectorXd& displacement, const Eigen::VectorXd& step) const;  // share, 0 to 1
    // Whether an edge of the surface passes through a triangle; edges and triangles whose places are not numbers do
    // not.
    bool intersects(const Eigen::VectorXd& displacement) const;

    std::array<int, 4> nodes_of(const NearPair& pair) const;
    FourPoints points_of(const std::array<int, 4>& nodes, const Eigen::VectorXd& displacement) const;
    FourPoints at_rest(const std::array<int, 4>& nodes) const;
    // Whether a pair can be within a distance, by how far its nodes have moved against each other since the search.
    bool may_be_within(const NearPair& pair, const std::array<int, 4>& nodes, const Eigen::VectorXd& displacement,
                       double distance_m) const;

private:
    void search(const Eigen::VectorXd& displacement, const Eigen::VectorXd& step) const;
    bool is_covered(const Eigen::VectorXd& displacement) const;

    double range_m_;
    pbs::Positions rest_;
    ContactSurface surface_;
    mutable std::vector<NearPair> near_;   // of the last search
    mutable Eigen::VectorXd from_, step_;  // [m], #dofs; empty before the first search
};

}  // namespace reference_fem
