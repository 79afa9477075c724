// The reference's own error bar: its pose solved again, with the other element order, on refined tets or both, and the grid convergence
// index (analysis/grid_convergence.hpp) of the differences on the character's own vertices, in the norms of the deformers' errors.
//
// Mesh size: of nodes, (number of nodes)^(-1/3) (Celik et al. 2008), so that order 1 and 2 on the same tets are two grids of a ratio of
// about 1.9; a refinement halves it. The order is presumed to be 1 whatever the elements: the bones hold capsules whose surface no face of
// a tet follows and across which the displacement's gradient jumps, so that the displacement lies in H^(3/2 - eps), its energy error falls
// with h^(1/2) and, by duality, its own with h; where whole tets are held, edges with an angle of up to 360 degrees in the flesh give
// the same. With the factor 3 of two grids that covers orders down to 0.27 (refined) and, between element orders, a reference of order 2
// with up to 3/4 of the error of order 1. With three solutions the order is observed, used up to 1, and the factor is 1.25 where it is
// within a tenth of 1 and 3 elsewhere: a series of both element orders shows a higher order than one of finer tets (measured on the limb,
// at the joint: 1.2 and 1.5 where finer tets have 0.7 and 0.8), and 1.25 was seen to be too little for it.
// The bar is of the mesh alone: not of the material, the attachment's sample points or the time step.
#pragma once

#include "experiments/deformers/registry.hpp"
#include "experiments/scene/error_bar.hpp"
#include "experiments/run/frame_measurement.hpp"

#include <array>
#include <memory>
#include <optional>

namespace experiments {

class ReferenceErrorBar {
public:
    // Solves `reference`, a [[fem]] one, beside the solution on `character`, which outlives this.
    ReferenceErrorBar(ErrorBar kind, const DeformerSpec& reference, const pbs::Character& character);

    void advance(const pbs::Pose& pose, double dt_s);  // the further solutions, whenever the reference advances

    // How far the reference may be from the limit, in each norm; nothing where one of the solutions has not converged.
    std::optional<analysis::ErrorNorms> bound(const pbs::Positions& reference, const FrameMeasurer& measurer);

    nlohmann::json method() const;  // for the record: the solutions and their cost, ratios, orders, factor, what was observed

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
    std::vector<double> ratios() const;  // of mesh sizes, each over the next finer one's
    double norm_bound(std::size_t norm, const std::vector<double>& distances);

    ErrorBar kind_;
    const pbs::Character& character_;
    std::vector<Solution> solutions_;                    // the finest first
    std::size_t reference_ = 0;                          // its place among them
    std::array<std::vector<double>, 3> observed_order_;  // of each norm, a value a frame; three solutions
    std::array<int, 3> frames_asymptotic_{};             // of each norm
    std::vector<double> alignment_;                      // of the differences in the first norm
    int frames_ = 0, frames_without_ = 0;
};

}  // namespace experiments
