// The point of a surface that is nearest to a given point.
#pragma once

#include "pbs/geometry/types.hpp"

#include <memory>

namespace pbs {

// A point of a triangle.
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
    SurfacePoint nearest(const Vec3& point) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace pbs
