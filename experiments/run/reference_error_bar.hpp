// The error bar of the reference. Each pose is solved again with the other element order, on refined tets, or both. The grid convergence
// index (analysis/grid_convergence.hpp) of the differences on the character's vertices, in the norms of the deformers' errors, is the bar.
//
// The mesh size is (number of nodes)^(-1/3) (Celik et al. 2008). Order 1 and order 2 on the same tets are therefore two grids with a ratio
// of about 1.9, and a refinement halves the mesh size.
//
// The order of convergence is presumed to be 1 for both element orders. The bones hold capsules. No faces of tets follow their surface, and
// the gradient of the displacement jumps across it. The displacement therefore lies in H^(3/2 - eps), its energy error falls with h^(1/2),
// and its own error, by duality, with h. Where whole tets are held, edges with an angle of up to 360 degrees in the flesh have the same
// effect.
//
// With two solutions the safety factor is 3. This covers orders down to 0.27 (refined tets), and a reference of order 2 with up to 3/4 of
// the error of order 1 (other element order). With three solutions the order is observed and used up to 1. The factor is then 1.25 if the
// observed order is within a tenth of 1, and 3 otherwise: a series of both element orders shows a higher order than one of finer tets (on
// the limb, at the joint: 1.2 and 1.5 instead of 0.7 and 0.8), for which 1.25 proved too small.
//
// The bar covers the mesh only, and neither the material, the sample points of the attachment nor the time step.
#pragma once

#include "experiments/deformers/registry.hpp"
#include "experiments/run/frame_measurement.hpp"

#include <array>
#include <memory>
#include <optional>

namespace experiments {

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
    double norm_bound(std::size_t norm, const std::vector<double>& distances);

    ErrorBar kind_;
    const pbs::Character& character_;
    std::vector<Solution> solutions_;                    // the finest first
    std::size_t reference_ = 0;                          // its place among them
    std::array<std::vector<double>, 3> observed_order_;  // by norm, one value per frame; with three solutions only
    std::array<int, 3> frames_asymptotic_{};             // by norm
    std::vector<double> alignment_;                      // of the differences in the first norm
    int frames_ = 0, frames_without_ = 0;
};

}  // namespace experiments
