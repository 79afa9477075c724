// The jump of strain between neighbouring tets, computed differently from SmoothnessMetrics: Green's strain of a tet follows from the
// change of its six edge lengths, l^2 - L^2 = 2 e^T E e, without a deformation gradient; areas by Heron's formula.
//   hand_strain_jump(mesh, near, positions)   // rms over inner faces, weighted by rest area
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace test_support {

inline Eigen::Matrix3d strain_by_lengths(const pbs::Positions& rest, const pbs::Positions& now, const std::array<int, 4>& tet)
{
    Eigen::Matrix<double, 6, 6> of_components;
    Eigen::Matrix<double, 6, 1> changes;
    int row = 0;
    for (int a = 0; a < 4; ++a)
        for (int b = a + 1; b < 4; ++b, ++row) {
            const pbs::Vec3 e = rest.row(tet[b]) - rest.row(tet[a]), moved = now.row(tet[b]) - now.row(tet[a]);
            of_components.row(row) << e.x() * e.x(), e.y() * e.y(), e.z() * e.z(), 2 * e.x() * e.y(), 2 * e.x() * e.z(), 2 * e.y() * e.z();
            changes(row) = 0.5 * (moved.squaredNorm() - e.squaredNorm());
        }
    const Eigen::Matrix<double, 6, 1> c = of_components.fullPivLu().solve(changes);
    Eigen::Matrix3d strain;
    strain << c(0), c(3), c(4), c(3), c(1), c(5), c(4), c(5), c(2);
    return strain;
}

inline double heron(const pbs::Positions& points, const std::set<int>& corners)
{
    const std::vector<int> v(corners.begin(), corners.end());
    const double a = (points.row(v[1]) - points.row(v[0])).norm(), b = (points.row(v[2]) - points.row(v[1])).norm(),
                 c = (points.row(v[0]) - points.row(v[2])).norm(), half = 0.5 * (a + b + c);
    return std::sqrt(half * (half - a) * (half - b) * (half - c));
}

inline double hand_strain_jump(const pbs::TetMesh& mesh, const std::vector<bool>& near, const pbs::Positions& now)
{
    std::map<std::set<int>, std::vector<Eigen::Matrix3d>> sides;  // the strains of the tets on both sides of each face of the region
    for (const auto row : mesh.tets.rowwise()) {
        const std::array<int, 4> tet = {row(0), row(1), row(2), row(3)};
        const Eigen::Matrix3d strain = strain_by_lengths(mesh.rest, now, tet);
        for (const int opposite : tet) {
            std::set<int> face(tet.begin(), tet.end());
            face.erase(opposite);
            bool inside = true;
            for (const int corner : face) inside = inside && near[corner];
            if (inside) sides[face].push_back(strain);
        }
    }
    double squares = 0.0, area = 0.0;
    for (const auto& [face, strains] : sides) {
        if (strains.size() != 2) continue;  // a face of the skin
        squares += heron(mesh.rest, face) * (strains[0] - strains[1]).squaredNorm();
        area += heron(mesh.rest, face);
    }
    return std::sqrt(squares / area);
}

}  // namespace test_support
