#include "pbs/character/nearest_triangle.hpp"

#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pbs {
namespace {

using Box = Eigen::AlignedBox3d;

Vec3 nearest_on_segment(const Vec3& point, const Vec3& a, const Vec3& b, int from, int to)
{
    const double length2 = (b - a).squaredNorm();
    const double parameter = length2 > 0.0 ? std::clamp((point - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
    Vec3 barycentric = Vec3::Zero();
    barycentric(from) += 1.0 - parameter;
    barycentric(to) += parameter;
    return barycentric;
}

// Barycentric coordinates of the point of a triangle that is nearest: that of its plane if it lies inside, else the best of its edges.
Vec3 nearest_in_triangle(const Vec3& point, const Eigen::Matrix3d& corners)
{
    const Vec3 a = corners.row(0), b = corners.row(1), c = corners.row(2), normal = (b - a).cross(c - a);
    const double area2 = normal.squaredNorm();
    if (area2 > 0.0) {
        const Vec3 barycentric(normal.dot((c - b).cross(point - b)) / area2, normal.dot((a - c).cross(point - c)) / area2,
                               normal.dot((b - a).cross(point - a)) / area2);
        if (barycentric.minCoeff() >= 0.0) return barycentric / barycentric.sum();
    }
    Vec3 best = Vec3::UnitX();
    double least = std::numeric_limits<double>::max();
    for (const Vec3& candidate :
         {nearest_on_segment(point, a, b, 0, 1), nearest_on_segment(point, b, c, 1, 2), nearest_on_segment(point, c, a, 2, 0)}) {
        const double distance = (corners.transpose() * candidate - point).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        best = candidate;
    }
    return best;
}

}  // namespace

struct SurfaceTree::Tree {
    const Positions& points;
    const Triangles& triangles;
    Eigen::KdBVH<double, 3, int> boxes = {};

    Eigen::Matrix3d corners(int triangle) const
    {
        Eigen::Matrix3d corners;
        for (int k = 0; k < 3; ++k) corners.row(k) = points.row(triangles(triangle, k));
        return corners;
    }
};

namespace {

// The functor of Eigen's BVMinimize, and the triangle at which it ended.
template <typename Tree>
struct NearestTriangle {
    using Scalar = double;
    const Tree& tree;
    Vec3 point;
    double least = std::numeric_limits<double>::max();
    SurfacePoint found = {};

    double minimumOnVolume(const Box& box) const { return box.squaredExteriorDistance(point); }
    double minimumOnObject(int triangle)
    {
        const Eigen::Matrix3d corners = tree.corners(triangle);
        const Vec3 barycentric = nearest_in_triangle(point, corners);
        const double distance = (corners.transpose() * barycentric - point).squaredNorm();
        if (distance < least) {
            least = distance;
            found = {triangle, barycentric, std::sqrt(distance)};
        }
        return distance;
    }
};

}  // namespace

SurfaceTree::SurfaceTree(const Positions& points, const Triangles& triangles) : tree_(new Tree{points, triangles})
{
    std::vector<int> objects;
    std::vector<Box> boxes;
    for (int triangle = 0; triangle < triangles.rows(); ++triangle) {
        const Eigen::Matrix3d corners = tree_->corners(triangle);
        objects.push_back(triangle);
        boxes.emplace_back(Vec3(corners.colwise().minCoeff()), Vec3(corners.colwise().maxCoeff()));
    }
    tree_->boxes.init(objects.begin(), objects.end(), boxes.begin(), boxes.end());
}

SurfaceTree::~SurfaceTree() = default;

SurfacePoint SurfaceTree::nearest(const Vec3& point) const
{
    NearestTriangle<Tree> search{*tree_, point};
    Eigen::BVMinimize(tree_->boxes, search);
    return search.found;
}

}  // namespace pbs
