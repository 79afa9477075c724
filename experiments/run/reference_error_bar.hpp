// The error bar of the reference: it is solved with linear and quadratic elements on the character's tets and on these
// tets cut into eight. The distances of the other solutions from the finest one give the order of convergence, observed
// at the joints, and a bound of the reference's own error in the norms of the deformers' errors, on the character's
// vertices (analysis/statistics/grid_convergence.hpp).
//
// The theoretical order, which the observed one may not exceed, depends on the attachment. The density of smooth
// springs has no jump. The displacement in the L2 norm then converges with order 2 for linear and 3 for quadratic
// elements, of which the lower one is used. In any other attachment it is 1 for both element orders: the bones hold
// capsules, whose surface no face of a tet follows and across which the gradient of the displacement jumps. The
// displacement therefore lies in H^(3/2 - eps), its energy error falls with h^(1/2), and its own error, by duality,
// with h. Where whole tets are held, edges with an angle of up to 360 degrees in the flesh have the same effect.
//
// The bar covers the mesh only, and neither the material, the sample points of the attachment nor the time step.
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/frame_measurement.hpp"

#include <array>
#include <memory>
#include <functional>
#include <optional>

namespace experiments {

// The theoretical order of convergence of the displacement.
double convergence_order(FemAttachment attachment);

class ReferenceErrorBar {
public:
    // Prepares the further solutions of `reference`, a [[fem]] deformer, on `character`, which must outlive this
    // object.
    ReferenceErrorBar(const DeformerSpec& reference, const pbs::Character& character);
    ReferenceErrorBar(ReferenceErrorBar&&) = delete;  // its solutions refer to its own refined character

    // the further solutions; to be called whenever the reference advances
    void advance(const pbs::Pose& pose, double dt_s);

    void give_up_when(const std::function<bool()>& is_over);  // as Deformer::give_up_when, for all of them

    // A bound of the reference's distance from the limit of ever finer tets, in each norm; nothing if a solution has
    // not converged.
    std::optional<analysis::ErrorNorms> bound(const pbs::Positions& reference, const FrameMeasurer& measurer);

    // for the record: the solutions with their cost, the orders, factors and observations
    nlohmann::json method() const;

private:
    struct Solution {
        int element_order = 0;
        const pbs::Character* character = nullptr;
        std::unique_ptr<Deformer> deformer = {};  // null: the reference itself
        pbs::StepSummary step = {};
        double seconds = 0.0;
    };

    FemAttachment attachment_;
    pbs::Character refined_;
    std::array<Solution, 4> solutions_;    // the finest, quadratic elements, linear ones on refined tets, linear ones
    std::vector<double> observed_orders_;  // of each frame in which the solutions differ and show an order
    int frames_ = 0, frames_without_ = 0, frames_reliable_ = 0;
};

}  // namespace experiments
