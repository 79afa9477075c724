// Triangulated sphere and torus, oriented outward, vertices on the surface.
#pragma once

#include "experiments/meshes/mesh_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace test_support {

// The icosahedron with each triangle split into four, `splits` times: 20 * 4^splits triangles. Radius [m].
inline pbs::SurfaceMesh icosphere(double radius, int splits)
{
    const double g = std::numbers::phi;
    std::vector<pbs::Vec3> points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                     {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    std::vector<std::array<int, 3>> triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int split = 0; split < splits; ++split) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [entry, is_new] = middles.emplace(std::minmax(a, b), static_cast<int>(points.size()));
            if (is_new) points.push_back(points[std::size_t(a)] + points[std::size_t(b)]);
            return entry->second;
        };
        std::vector<std::array<int, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        triangles = finer;
        for (pbs::Vec3& p : points) p.normalize();
    }
    pbs::SurfaceMesh sphere{pbs::Positions(points.size(), 3), pbs::Triangles(triangles.size(), 3)};
    for (std::size_t i = 0; i < points.size(); ++i)
        sphere.points.row(Eigen::Index(i)) = radius * points[i].normalized().transpose();
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (int k = 0; k < 3; ++k) sphere.triangles(Eigen::Index(f), k) = triangles[f][std::size_t(k)];
    return sphere;
}

// Volume [m^3] inside a closed surface, by the divergence theorem; inward triangles count negative.
inline double enclosed_volume(const pbs::Positions& points, const pbs::Triangles& triangles)
{
    double six_volumes = 0.0;
    for (const auto& triangle : triangles.rowwise()) {
        const pbs::Vec3 a = points.row(triangle(0)), b = points.row(triangle(1)), c = points.row(triangle(2));
        six_volumes += a.dot(b.cross(c));
    }
    return six_volumes / 6.0;
}

// A torus around the z axis: ring radius and tube radius [m], `around` x `across` quads, two triangles each.
inline pbs::SurfaceMesh torus(double ring, double tube, int around, int across)
{
    pbs::SurfaceMesh torus{pbs::Positions(around * across, 3), pbs::Triangles(2 * around * across, 3)};
    const auto index = [&](int i, int j) { return (i % around) * across + j % across; };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
            const double r = ring + tube * std::cos(v);
            torus.points.row(index(i, j)) << r * std::cos(u), r * std::sin(u), tube * std::sin(v);
            torus.triangles.row(2 * index(i, j)) << index(i, j), index(i + 1, j), index(i + 1, j + 1);
            torus.triangles.row(2 * index(i, j) + 1) << index(i, j), index(i + 1, j + 1), index(i, j + 1);
        }
    return torus;
}

}  // namespace test_support
