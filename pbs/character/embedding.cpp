#include "pbs/character/embedding.hpp"

#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pbs {
namespace {

using Box = Eigen::AlignedBox3d;
using TetCorners = Eigen::Matrix<double, 4, 3>;

TetCorners corners_of(const TetMesh& mesh, int tet)
{
    TetCorners corners;
    for (int corner = 0; corner < 4; ++corner) corners.row(corner) = mesh.rest.row(mesh.tets(tet, corner));
    return corners;
}

Eigen::Vector4d barycentric_in_tet(const Vec3& point, const TetCorners& corners)
{
    Eigen::Matrix3d edges;
    for (int corner = 1; corner < 4; ++corner) edges.col(corner - 1) = (corners.row(corner) - corners.row(0)).transpose();
    const Vec3 along = edges.inverse() * (point - corners.row(0).transpose());
    return {1.0 - along.sum(), along(0), along(1), along(2)};
}

double squared_distance_to_segment(const Vec3& point, const Vec3& a, const Vec3& b)
{
    const double parameter = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (point - a - parameter * (b - a)).squaredNorm();
}

double squared_distance_to_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 normal = (b - a).cross(c - a);
    const bool above_it =
        normal.cross(b - a).dot(point - a) >= 0.0 && normal.cross(c - b).dot(point - b) >= 0.0 && normal.cross(a - c).dot(point - c) >= 0.0;
    if (above_it) return std::pow(normal.dot(point - a), 2) / normal.squaredNorm();
    return std::min(
        {squared_distance_to_segment(point, a, b), squared_distance_to_segment(point, b, c), squared_distance_to_segment(point, c, a)});
}

double squared_distance_to_tet(const Vec3& point, const TetCorners& corners)
{
    if (barycentric_in_tet(point, corners).minCoeff() >= 0.0) return 0.0;
    double least = std::numeric_limits<double>::max();
    for (int opposite = 0; opposite < 4; ++opposite)
        least = std::min(least, squared_distance_to_triangle(point, corners.row((opposite + 1) % 4), corners.row((opposite + 2) % 4),
                                                             corners.row((opposite + 3) % 4)));
    return least;
}

// The functor of Eigen's BVMinimize, and the tet at which it ended.
struct NearestTet {
    using Scalar = double;
    const TetMesh& mesh;
    Vec3 point;
    double least = std::numeric_limits<double>::max();
    int tet = -1;

    double minimumOnVolume(const Box& box) const { return box.squaredExteriorDistance(point); }
    double minimumOnObject(int candidate)
    {
        const double distance = squared_distance_to_tet(point, corners_of(mesh, candidate));
        if (distance < least) {
            least = distance;
            tet = candidate;
        }
        return distance;
    }
};

Eigen::KdBVH<double, 3, int> tree_of_tets(const TetMesh& mesh)
{
    std::vector<int> tets;
    std::vector<Box> boxes;
    for (int t = 0; t < mesh.tets.rows(); ++t) {
        const TetCorners corners = corners_of(mesh, t);
        tets.push_back(t);
        boxes.emplace_back(Vec3(corners.colwise().minCoeff()), Vec3(corners.colwise().maxCoeff()));
    }
    return {tets.begin(), tets.end(), boxes.begin(), boxes.end()};
}

}  // namespace

EmbeddedSurface embed(const Positions& surface, const Triangles& triangles, const TetMesh& mesh)
{
    const Eigen::KdBVH<double, 3, int> tree = tree_of_tets(mesh);
    EmbeddedSurface embedded{triangles, Eigen::VectorXi(surface.rows()), {}, 0.0};
    embedded.barycentric.resize(surface.rows(), 4);
    for (Eigen::Index s = 0; s < surface.rows(); ++s) {
        NearestTet nearest{mesh, surface.row(s).transpose()};
        Eigen::BVMinimize(tree, nearest);
        embedded.tet(s) = nearest.tet;
        embedded.barycentric.row(s) = barycentric_in_tet(nearest.point, corners_of(mesh, nearest.tet)).transpose();
        embedded.largest_distance_outside_m = std::max(embedded.largest_distance_outside_m, std::sqrt(nearest.least));
    }
    return embedded;
}

EmbeddedSurface embed_in_children(const EmbeddedSurface& surface, const TetMesh& coarse, const TetMesh& fine)
{
    constexpr int children = 8;
    const Positions points = embedded_positions(surface, coarse.rest, coarse.tets);
    EmbeddedSurface embedded = surface;
    for (Eigen::Index s = 0; s < surface.tet.rows(); ++s) {
        double most_inside = -std::numeric_limits<double>::max();
        for (int child = children * surface.tet(s); child < children * (surface.tet(s) + 1); ++child) {
            const Eigen::Vector4d barycentric = barycentric_in_tet(points.row(s).transpose(), corners_of(fine, child));
            if (barycentric.minCoeff() <= most_inside) continue;
            most_inside = barycentric.minCoeff();
            embedded.tet(s) = child;
            embedded.barycentric.row(s) = barycentric.transpose();
        }
    }
    return embedded;
}

Positions embedded_positions(const EmbeddedSurface& surface, const Positions& positions, const Tets& tets)
{
    Positions points = Positions::Zero(surface.tet.rows(), 3);
    for (Eigen::Index s = 0; s < surface.tet.rows(); ++s)
        for (int corner = 0; corner < 4; ++corner)
            points.row(s) += surface.barycentric(s, corner) * positions.row(tets(surface.tet(s), corner));
    return points;
}

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
