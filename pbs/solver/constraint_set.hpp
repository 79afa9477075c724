// What is the same in every frame: the constraints of a mesh with their rest data, in the order in which they are
// projected, and the masses.
#pragma once

#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/region_volume.hpp"
#include "pbs/constraints/stretch.hpp"
#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"

#include <vector>

namespace pbs {

// File order: bind by vertex, stretch by edges_of(tets), volume by tet. Classes of stiffness zero are empty.
// Stiffnesses are those of one projection, by share_removed.
template <typename Scalar>
struct ConstraintSet {
    std::vector<BindConstraint<Scalar>> bind;        // at most one per vertex
    std::vector<StretchConstraint<Scalar>> stretch;  // at most one per edge
    std::vector<VolumeConstraint<Scalar>> volume;    // one per tet, or none
    // unit: 1; lumped: mean lumped volume / lumped volume of the vertex, so that no unit enters; held: 0, #V
    std::vector<Scalar> inverse_mass;
    // by the numbers of tet_regions; none unless VolumeOf asks for them
    std::vector<RegionVolumeConstraint<Scalar>> regions = {};
};

// InputError for stiffnesses outside [0, 1], iterations below 0, threads below 1, and a stop_residual or
// sleep_tolerance that is negative or NaN.
void check_options(const PbsOptions& options);

// The share of its error that a projection of a constraint of stiffness k removes, by options.stiffness_form.
double share_removed(double k, const PbsOptions& options);

// The stiffness of an edge of rest length l0 [m] so that the stiffness of the material does not depend on the edges'
// lengths, where k is that of an edge of `length_m`:  k_e / (1 - k_e) = k / (1 - k) (length_m / l0)^2. Derivation: a
// projection removes the share w / (w + alpha / dt^2) of C, with w the inverse masses and alpha the compliance (M.
// Macklin, M. Mueller, N. Chentanez, XPBD, MIG 2016, Eq. 18). In a mesh of edges h, masses are in proportion to h^3,
// and an edge stands for a bar of section h^2 and length h, so that 1 / alpha is in proportion to h. Hence k / (1 - k)
// = w dt^2 / alpha is in proportion to 1 / h^2. For small k the same follows from the diffusion of displacements by k
// h^2 / 2 per iteration, which is kept. 0 and 1 stay as they are. length_m = 0: k for edges of every length.
double stiffness_at_length(double k, double l0_m, double length_m);

// bind_distance [m], #V; jiggle_zone: #V, or empty: nothing jiggles; held: #V, or empty: nothing is held. InputErrors:
// as check_options, wrong sizes, vertex indices out of range, tets without a positive rest volume, and vertices held
// although they jiggle, all are integrated (LbsEntry::increment) or Eq. 12-20 are taken as printed (which know no
// mass).
template <typename Scalar>
ConstraintSet<Scalar> make_constraint_set(const TetMesh& mesh, const Eigen::VectorXd& bind_distance,
                                          const std::vector<bool>& jiggle_zone, const PbsOptions& options,
                                          const std::vector<bool>& held = {});

// The order `spread`: neighbours in the list come from eight distant parts of the old list in turn, so that no
// projection waits for the stores of the one before. In file order, edges share their first vertex with their
// neighbours.
//   const ConstraintSet<double> spread = in_spread_order(make_constraint_set<double>(...));
template <typename Constraints>
Constraints in_spread_order(Constraints constraints)
{
    const auto spread = [](auto& list) {
        constexpr std::size_t parts = 8;
        const auto before = list;
        const std::size_t length = (before.size() + parts - 1) / parts;
        list.clear();
        for (std::size_t i = 0; i < length; ++i)
            for (std::size_t k = i; k < before.size(); k += length) list.push_back(before[k]);
    };
    spread(constraints.stretch);
    spread(constraints.volume);
    return constraints;
}

}  // namespace pbs
