// The error bar of the reference. Each pose is solved again with the other element order, on refined tets, or both. Where the reference's
// own error lies follows from the differences on the character's vertices, in the norms of the deformers' errors.
//
// The mesh size is (number of nodes)^(-1/3) (Celik et al. 2008). Order 1 and order 2 on the same tets are therefore two grids with a ratio
// of about 1.9, and a refinement halves the mesh size.
//
// With two solutions nothing is observed: the bar is the grid convergence index (analysis/statistics/grid_convergence.hpp) with the
// theoretical order and the safety factor 3. With four solutions, of both element orders on both meshes, the order of linear elements is
// observed at the joints and used for all, between 0.5 and the theoretical one. The factor is 1.25 where the observed order is credible,
// and otherwise 3 (analysis/statistics/grid_convergence.hpp).
//
// The theoretical order depends on the attachment. The density of smooth springs has no jump. The displacement in the L2 norm then
// converges with order 2 for linear and 3 for quadratic elements, of which the lower one is used, since the solutions are of both. In any
// other attachment it is 1 for both element orders: the bones hold capsules, whose surface no face of a tet follows and across which the
// gradient of the displacement jumps. The displacement therefore lies in H^(3/2 - eps), its energy error falls with h^(1/2), and its own
// error, by duality, with h. Where whole tets are held, edges with an angle of up to 360 degrees in the flesh have the same effect.
//
// The bar covers the mesh only, and neither the material, the sample points of the attachment nor the time step.
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/frame_measurement.hpp"

#include <memory>
#include <optional>

namespace experiments {

// The theoretical order of convergence of the displacement.
double convergence_order(FemAttachment attachment);

class ReferenceErrorBar {
public:
    // Prepares the further solutions of `reference`, a [[fem]] deformer, on `character`, which must outlive this object.
    ReferenceErrorBar(ErrorBar kind, const DeformerSpec& reference, const pbs::Character& character);

    void advance(const pbs::Pose& pose, double dt_s);  // the further solutions; to be called whenever the reference advances

    // A bound of the reference's distance from the limit of ever finer tets, in each norm; nothing if a solution has not converged.
    std::optional<analysis::ErrorNorms> bound(const pbs::Positions& reference, const FrameMeasurer& measurer);

    nlohmann::json method() const;  // for the record: the solutions with their cost, the ratios, orders, factor and observations

private:
    struct Solution {
        int element_order = 0, refinements = 0;
        double nodes_along = 0.0;                         // (number of nodes)^(1/3): 1 / mesh size
        std::shared_ptr<const pbs::Character> character;  // null: the reference's own
        std::unique_ptr<Deformer> deformer;               // null: the reference itself
        pbs::StepSummary step;
        double seconds = 0.0;
    };
    void add_solution(const DeformerSpec& reference, int element_order, int refinements);
    std::vector<double> ratios() const;  // of each mesh size to the next finer one
    analysis::ErrorNorms bound_of_four(const std::vector<pbs::Positions>& positions, const FrameMeasurer& measurer);

    ErrorBar kind_;
    FemAttachment attachment_;
    const pbs::Character& character_;
    std::vector<Solution> solutions_;      // the finest first
    std::size_t reference_ = 0;            // its place among them
    std::vector<double> observed_orders_;  // with four solutions, one value per frame in which they differ and show an order
    int frames_ = 0, frames_without_ = 0, frames_reliable_ = 0;
};

}  // namespace experiments
