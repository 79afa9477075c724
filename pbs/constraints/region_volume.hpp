// The volume constraint of a region, a set of tets: the sum of their volumes is kept,
//   C(p) = sum_t V_t - V0 = sum_(a, b, c) (a - o) . (b - a) x (c - a) / 6 - V0,
// where (a, b, c) are the triangles of the region's surface, by the divergence theorem. Vertices inside the region do
// not enter it, and it holds for any origin o.
//   const auto region = make_region_volume_constraint<double>(surface, rest, 1.0);
//   project(region, w, p, g);
// Tets within the region may exchange volume. Source: the volume constraint of closed meshes, M. Mueller et al.,
// Position based dynamics, Journal of Visual Communication and Image Representation 18, 2007, Eq. 14, with a region's
// surface for the mesh. p: positions [m], w: inverse masses in any common unit, each one entry per vertex of the
// region.
#pragma once

#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace pbs {

// Scalar: float or double.
template <typename Scalar>
struct RegionVolumeConstraint {
    // of the surface: their numbers in the mesh; value, gradient and project do not read them
    std::vector<int> vertex = {};
    std::vector<std::array<int, 3>> triangle = {};  // oriented outward, places in `vertex`
    Scalar rest_volume;                             // V0 [m^3], positive
    Scalar stiffness;                               // in [0, 1]
    int largest_fan = 0;                            // triangles at the vertex with most of them
};

// Both at once; g: as gradient returns it.
template <typename Scalar>
Scalar value_and_gradient(const RegionVolumeConstraint<Scalar>& constraint, const std::vector<Vector3<Scalar>>& p,
                          std::vector<Vector3<Scalar>>& g)
{
    g.assign(p.size(), Vector3<Scalar>::Zero());
    Scalar volume = 0;
    for (const std::array<int, 3>& triangle : constraint.triangle) {
        const Vector3<Scalar>& a = p[triangle[0]];
        const Vector3<Scalar> third_of_area = sixth<Scalar> * (p[triangle[1]] - a).cross(p[triangle[2]] - a);
        volume += third_of_area.dot(a - p.front());
        for (const int corner : triangle) g[corner] += third_of_area;
    }
    return volume - constraint.rest_volume;
}

// C [m^3]. The origin o is the first vertex.
template <typename Scalar>
Scalar value(const RegionVolumeConstraint<Scalar>& constraint, const std::vector<Vector3<Scalar>>& p)
{
    std::vector<Vector3<Scalar>> g;
    return value_and_gradient(constraint, p, g);
}

// grad C [m^2]: a third of the area vectors of the triangles around each vertex. Their sum is zero, as the surface is
// closed.
template <typename Scalar>
std::vector<Vector3<Scalar>> gradient(const RegionVolumeConstraint<Scalar>& constraint,
                                      const std::vector<Vector3<Scalar>>& p)
{
    std::vector<Vector3<Scalar>> g;
    value_and_gradient(constraint, p, g);
    return g;
}

// Moves the vertices [m] by the share k of what removes the linearised C. A region collapsed to a line or a point has
// no gradient and stays; what counts as no gradient is rounding_of_gradients (volume.hpp) for every triangle around a
// vertex. g: memory for the gradient.
template <typename Scalar>
void project(const RegionVolumeConstraint<Scalar>& constraint, const std::vector<Scalar>& w,
             std::vector<Vector3<Scalar>>& p, std::vector<Vector3<Scalar>>& g)
{
    const Scalar C = value_and_gradient(constraint, p, g);
    Scalar denominator = 0, sum_of_w = 0, longest2 = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        denominator += w[i] * g[i].squaredNorm();
        sum_of_w += w[i];
        longest2 = std::max(longest2, (p[i] - p.front()).squaredNorm());
    }
    const Scalar fan = Scalar(constraint.largest_fan);
    if (!(denominator > fan * fan * rounding_of_gradients(longest2, sum_of_w))) return;
    const Scalar k_s = constraint.stiffness * C / denominator;             // s of Eq. 21
    for (std::size_t i = 0; i < p.size(); ++i) p[i] -= k_s * w[i] * g[i];  // Eq. 8
}

// surface: closed, oriented outward, of vertices of the mesh, #F x 3; rest [m], #V x 3.
template <typename Scalar>
RegionVolumeConstraint<Scalar> make_region_volume_constraint(const Triangles& surface, const Positions& rest, double k)
{
    RegionVolumeConstraint<double> constraint{.rest_volume = 0.0, .stiffness = k};
    std::map<int, int> place;
    for (const auto triangle : surface.rowwise())
        for (const int v : triangle) place.emplace(v, 0);
    std::vector<Vector3<double>> p;
    for (auto& [v, at] : place) {
        at = static_cast<int>(p.size());
        constraint.vertex.push_back(v);
        p.push_back(rest.row(v));
    }
    std::vector<int> fan(p.size(), 0);
    for (const auto triangle : surface.rowwise()) {
        constraint.triangle.push_back({place[triangle(0)], place[triangle(1)], place[triangle(2)]});
        for (const int corner : constraint.triangle.back()) ++fan[corner];
    }
    const double volume = value(constraint, p);
    return {constraint.vertex, constraint.triangle, Scalar(volume), Scalar(k), *std::ranges::max_element(fan)};
}

}  // namespace pbs
