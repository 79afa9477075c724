// Order `plain`: one constraint after the other in file order, as the paper reads.
// p: particle positions [m], #V; q: posed bind points [m], #V.
#pragma once

#include "pbs/constraints/region_volume.hpp"
#include "pbs/constraints/volume_printed.hpp"
#include "pbs/solver/constraint_set.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace pbs {

// Line 11 of Algorithm 1.
template <typename Scalar>
void project_bind_constraints(const ConstraintSet<Scalar>& constraints, const std::vector<Vector3<Scalar>>& q,
                              std::vector<Vector3<Scalar>>& p);

// Line 12.
template <typename Scalar>
void project_stretch_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p);

// Line 13, derived from Eq. 11.
template <typename Scalar>
void project_volume_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p);

// The volumes of regions, one region after the other; after those of tets in line 13.
template <typename Scalar>
void project_region_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p);

// Eq. 12-20 as printed; masses are one there.
template <Printed form, typename Scalar>
void project_volume_constraints_printed(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p);

// The volumes of regions, one region after the other, on positions in any layout.
//   project_regions(constraints.regions, constraints.inverse_mass, [&](int i) -> Vector3<Scalar>& { return p[i]; });
// position(i): the position of vertex i [m], a reference or an Eigen::Map.
template <typename Scalar, typename Position>
void project_regions(const std::vector<RegionVolumeConstraint<Scalar>>& regions,
                     const std::vector<Scalar>& inverse_mass, const Position& position)
{
    std::vector<Vector3<Scalar>> p, g;
    std::vector<Scalar> w;
    for (const RegionVolumeConstraint<Scalar>& region : regions) {
        p.clear();
        w.clear();
        for (const int v : region.vertex) {
            p.push_back(position(v));
            w.push_back(inverse_mass[v]);
        }
        project(region, w, p, g);
        for (std::size_t i = 0; i < p.size(); ++i) position(region.vertex[i]) = p[i];
    }
}

// Root mean square of V / V0 - 1; zero over none.
template <typename Scalar, typename Position>
double rms_of_regions(const std::vector<RegionVolumeConstraint<Scalar>>& regions, const Position& position)
{
    double sum = 0.0;
    std::vector<Vector3<Scalar>> p;
    for (const RegionVolumeConstraint<Scalar>& region : regions) {
        p.clear();
        for (const int v : region.vertex) p.push_back(position(v));
        const double e = value(region, p) / double(region.rest_volume);
        sum += e * e;
    }
    return regions.empty() ? 0.0 : std::sqrt(sum / double(regions.size()));
}

// The root mean square over two classes together, from that of each and their sizes. Without regions it is that of the
// first, to the bit.
inline double joint_rms(double first, std::size_t ones, double other, std::size_t others)
{
    if (others == 0) return first;
    return std::sqrt((first * first * double(ones) + other * other * double(others)) / double(ones + others));
}

}  // namespace pbs
