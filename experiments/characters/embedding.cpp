#include "experiments/characters/embedding.hpp"

#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace pbs {
namespace {

using Box = Eigen::AlignedBox3d;
using Tree = Eigen::KdBVH<double, 3, int>;
using TetCorners = Eigen::Matrix<double, 4, 3>;

constexpr double never = std::numeric_limits<double>::max();  // the squared distance of a cell that is not taken

TetCorners corners_of(const TetMesh& mesh, int tet)
{
    TetCorners corners;
    for (int corner = 0; corner < 4; ++corner) corners.row(corner) = mesh.rest.row(mesh.tets(tet, corner));
    return corners;
}

Eigen::Vector4d barycentric_in_tet(const Vec3& point, const TetCorners& corners)
{
    Eigen::Matrix3d edges;
    for (int corner = 1; corner < 4; ++corner)
        edges.col(corner - 1) = (corners.row(corner) - corners.row(0)).transpose();
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
    const bool above_it = normal.cross(b - a).dot(point - a) >= 0.0 && normal.cross(c - b).dot(point - b) >= 0.0 &&
                          normal.cross(a - c).dot(point - c) >= 0.0;
    if (above_it) return std::pow(normal.dot(point - a), 2) / normal.squaredNorm();
    return std::min({squared_distance_to_segment(point, a, b), squared_distance_to_segment(point, b, c),
                     squared_distance_to_segment(point, c, a)});
}

double squared_distance_to_tet(const Vec3& point, const TetCorners& corners)
{
    if (barycentric_in_tet(point, corners).minCoeff() >= 0.0) return 0.0;
    double least = std::numeric_limits<double>::max();
    for (int opposite = 0; opposite < 4; ++opposite)
        least = std::min(
            least, squared_distance_to_triangle(point, corners.row((opposite + 1) % 4), corners.row((opposite + 2) % 4),
                                                corners.row((opposite + 3) % 4)));
    return least;
}

// The functor of Eigen's BVMinimize, and the cell at which it ended. may_take is slow, and only asked where a cell
// would be the nearest.
template <typename SquaredDistance, typename MayTake>
struct NearestCell {
    using Scalar = double;
    Vec3 point;
    SquaredDistance squared_distance;  // of a cell
    MayTake may_take;                  // a cell
    double least = std::numeric_limits<double>::max();
    int cell = -1;

    double minimumOnVolume(const Box& box) const { return box.squaredExteriorDistance(point); }
    double minimumOnObject(int candidate)
    {
        const double distance = squared_distance(candidate);
        if (distance >= least) return distance;
        if (!may_take(candidate)) return never;
        cell = candidate;
        return least = distance;
    }
};

template <typename SquaredDistance, typename MayTake>
NearestCell<SquaredDistance, MayTake> nearest_cell(const Tree& tree, const Vec3& point,
                                                   const SquaredDistance& squared_distance, const MayTake& may_take)
{
    NearestCell<SquaredDistance, MayTake> nearest{point, squared_distance, may_take};
    Eigen::BVMinimize(tree, nearest);
    return nearest;
}

template <typename Cells>
Tree tree_of(const Positions& points, const Cells& cells)
{
    std::vector<int> numbers(static_cast<std::size_t>(cells.rows()));
    std::iota(numbers.begin(), numbers.end(), 0);
    std::vector<Box> boxes;
    for (const auto& cell : cells.rowwise()) {
        boxes.emplace_back();
        for (const int corner : cell) boxes.back().extend(Vec3(points.row(corner)));
    }
    return {numbers.begin(), numbers.end(), boxes.begin(), boxes.end()};
}

}  // namespace

EmbeddedSurface embed(const Positions& surface, const Triangles& triangles, const TetMesh& mesh,
                      const std::function<bool(Eigen::Index, int)>& may_carry)
{
    const Tree tree = tree_of(mesh.rest, mesh.tets);
    EmbeddedSurface embedded{triangles, Eigen::VectorXi(surface.rows()), {}, 0.0};
    embedded.barycentric.resize(surface.rows(), 4);
    for (Eigen::Index s = 0; s < surface.rows(); ++s) {
        const Vec3 point = surface.row(s);
        for (const bool is_restricted : {static_cast<bool>(may_carry), false}) {
            const auto nearest = nearest_cell(
                tree, point, [&](int tet) { return squared_distance_to_tet(point, corners_of(mesh, tet)); },
                [&](int tet) { return !is_restricted || may_carry(s, tet); });
            if (nearest.cell < 0) continue;
            embedded.tet(s) = nearest.cell;
            embedded.barycentric.row(s) = barycentric_in_tet(point, corners_of(mesh, nearest.cell)).transpose();
            embedded.largest_distance_outside_m =
                std::max(embedded.largest_distance_outside_m, std::sqrt(nearest.least));
            break;
        }
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

struct SurfaceTree::Tree {
    const Positions& points;
    const Triangles& triangles;
    Eigen::KdBVH<double, 3, int> boxes;
};

SurfaceTree::SurfaceTree(const Positions& points, const Triangles& triangles)
    : tree_(new Tree{points, triangles, tree_of(points, triangles)})
{
}

SurfaceTree::~SurfaceTree() = default;

SurfacePoint SurfaceTree::nearest(const Vec3& point, const std::function<bool(const SurfacePoint&)>& is_wanted) const
{
    Eigen::Matrix3d corners;
    const auto barycentric_in = [&](int triangle) {
        for (int k = 0; k < 3; ++k) corners.row(k) = tree_->points.row(tree_->triangles(triangle, k));
        return nearest_in_triangle(point, corners);
    };
    const auto squared_distance = [&](int triangle) {
        const Vec3 barycentric = barycentric_in(triangle);
        return (corners.transpose() * barycentric - point).squaredNorm();
    };
    const auto nearest = nearest_cell(tree_->boxes, point, squared_distance, [&](int triangle) {
        return !is_wanted || is_wanted({triangle, barycentric_in(triangle), 0.0});
    });
    if (nearest.cell < 0) return {};
    return {nearest.cell, barycentric_in(nearest.cell), std::sqrt(nearest.least)};
}

}  // namespace pbs
