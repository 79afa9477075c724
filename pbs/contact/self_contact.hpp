// Detection of self-contact: the skin vertices of a deformed body that lie in tets of another part of it, each with its
// depth constraint.
//   SelfContact<float> contact(mesh, place, 4);
//   contact.forget();                      // at the beginning of a frame
//   contact.find(x);                       // the constraints of these positions, once or more in a frame
//   contact.project(inverse_mass, x);      // once per iteration
// A pair of a vertex and a tet counts where X*, the point of the tet at rest that has come to the vertex, is farther
// than half of the mean edge from the vertex at rest. Positions decide alone, so that frames do not depend on each
// other, and there are no threads.
//
// Skin vertices lie in groups of neighbours, groups in clusters, and tets in blocks. The boxes of clusters and groups,
// compared sixteen at once, lead to the vertices in the box of a block. These are tried in all of its tets.
//
// No constraint where no direction can be trusted: in tets that are flat or mirrored, or strained more than tenfold
// along the way out, as after a teleport; and where a position is not finite.
#pragma once

#include "pbs/contact/depth_constraint.hpp"
#include "pbs/packed/batch.hpp"

#include <vector>

namespace pbs {

// The skin of a body at rest, with the point of it that is nearest to a point inside.
class RestSkin {
public:
    explicit RestSkin(const TetMesh& mesh);

    const std::vector<int>& vertices() const { return vertices_; }  // ascending

    // The nearest point of the skin [m]. The search begins at the skin near these vertices of the mesh and goes from
    // skin vertex to skin vertex as long as the next one is nearer, and then over the triangles around. Between two
    // sides that are about equally near it may find that of the other one.
    Vec3 nearest(const Vec3& point, const Eigen::Vector4i& near) const;

private:
    int descend(const Vec3& point, int skin_vertex) const;

    Positions rest_;
    Triangles triangles_;
    std::vector<int> vertices_;
    std::vector<int> first_, fan_;  // the triangles around vertex v: fan_[first_[v]] .. fan_[first_[v + 1] - 1]
    std::vector<int> near_;         // a skin vertex near each vertex, #V; -1: a part without skin, which has no tets
};

// Points divided into sets of neighbours by planes through the median across their longest extent.
struct PointSets {
    PointSets(const Positions& points, const std::vector<int>& members, int most_in_a_set);

    std::vector<int> first, member;  // #sets + 1; the members of a set ascend
    int sets() const { return static_cast<int>(first.size()) - 1; }
};

template <typename Scalar>
class SelfContact {
public:
    // place: the row of each vertex, #V; stride: numbers per row, x, y and z first.
    SelfContact(const TetMesh& mesh, const std::vector<int>& place, int stride);

    void forget() { constraints_.clear(); }  // at the beginning of a frame
    // The constraints at these positions, by vertex, then by tet. Vertices of constraints are those of the mesh. A
    // vertex that is in no tet now keeps the constraints it had, which hold it outside.
    void find(const Scalar* x);
    const std::vector<DepthConstraint<Scalar>>& constraints() const { return constraints_; }

    // Projects them once, one after the other. inverse_mass: of the vertices, #V.
    void project(const std::vector<Scalar>& inverse_mass, Scalar* x) const;

    std::array<Vector3<Scalar>, 5> points(const DepthConstraint<Scalar>& constraint, const Scalar* x) const;
    const RestSkin& skin() const { return skin_; }

private:
    using Kernels = ContactKernels<Scalar>;
    using Box = typename Kernels::Box;
    using Boxes = typename Kernels::Boxes;
    static constexpr int at_once =
        Kernels::at_once;  // at most: tets of a block, vertices of a group, groups of a cluster

    struct Hit {
        int vertex, tet;
    };

    void find_hits();
    void find_in_block(int block);
    void add_constraint(const Hit& hit);

    TetMesh mesh_;
    RestSkin skin_;
    double half_edge_m_;
    PointSets groups_, blocks_;
    std::vector<int> offset_;                      // of each vertex in x, #V
    std::vector<typename Kernels::Point> points_;  // the vertices as deformed, #V
    // offsets in points_ of the vertices of each group, and of each block
    std::vector<std::uint32_t> of_group_, of_block_;
    std::vector<int> first_of_block_;                 // #blocks + 1
    std::vector<typename Kernels::Corners> corners_;  // of each block
    // as deformed: of a group, of a cluster, of sixteen clusters
    std::vector<Boxes> vertex_boxes_, group_boxes_, cluster_boxes_;
    std::vector<std::uint32_t> inside_;  // offsets of the vertices in the box of a block
    // of each of these: bit k is that of the block's tet k
    std::vector<unsigned> tets_around_;
    std::vector<Hit> hits_;
    std::vector<DepthConstraint<Scalar>> constraints_;
};

}  // namespace pbs
