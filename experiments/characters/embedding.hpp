// A surface that a tet mesh carries. Each point of the surface keeps barycentric coordinates in one tet, which are
// extrapolated if the point lies outside.
//   const EmbeddedSurface skin = embed(surface.points, surface.triangles, mesh);
//   const Positions points = embedded_positions(skin, deformed, mesh.tets);
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <functional>
#include <memory>

namespace pbs {

// #S surface vertices in the tets of one mesh.
struct EmbeddedSurface {
    Triangles triangles;  // #F x 3
    Eigen::VectorXi tet;  // the tet that carries each surface vertex, #S
    // sums to one; negative where extrapolated, #S x 4
    Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor> barycentric;
    double largest_distance_outside_m = 0.0;  // of a surface vertex from the tets
};

// Embeds each point of `surface` [m], #S x 3, in the tet that holds it or is nearest to it in rest pose. The mesh has
// at least one tet, and none is flat (unchecked). may_carry(point, tet) excludes tets, unless all are excluded for a
// point; by default any tet may carry any point.
EmbeddedSurface embed(const Positions& surface, const Triangles& triangles, const TetMesh& mesh,
                      const std::function<bool(Eigen::Index, int)>& may_carry = {});

// The same surface points carried by the children of their tets, which `fine` holds in the order of pbs::refine.
EmbeddedSurface embed_in_children(const EmbeddedSurface& surface, const TetMesh& coarse, const TetMesh& fine);

// Surface positions [m], #S x 3, from deformed tet vertices [m], #V x 3.
Positions embedded_positions(const EmbeddedSurface& surface, const Positions& positions, const Tets& tets);

// The point of a surface that is nearest to a given point, by its triangle.
struct SurfacePoint {
    int triangle = -1;
    Vec3 barycentric = Vec3::Zero();  // 0 to 1, their sum is one
    double distance_m = 0.0;          // from the point that was asked for
};

// Points and triangles of the surface have to outlive it; triangles without area are points of their corners.
class SurfaceTree {
public:
    SurfaceTree(const Positions& points, const Triangles& triangles);  // #S x 3 [m], #F x 3 with #F > 0
    ~SurfaceTree();
    // is_wanted: only such points are taken; where there is none, the triangle is -1.
    SurfacePoint nearest(const Vec3& point, const std::function<bool(const SurfacePoint&)>& is_wanted = {}) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace pbs
