// A body under one of the methods, driven step by step. All cells use this interface, whatever their method.
//   const auto driven = make_driven_body(cell, character);
//   const pbs::StepSummary step = driven->advance(drive, dt);
#pragma once

#include "experiments/studies/stability/stability_body.hpp"
#include "pbs/solver/step_summary.hpp"

#include <memory>

namespace experiments {

class DrivenBody {
public:
    virtual ~DrivenBody() = default;
    virtual pbs::StepSummary advance(const Drive& drive, double dt_s) = 0;
    virtual const pbs::Positions& positions() const = 0;  // [m], #V x 3
};

std::unique_ptr<DrivenBody> make_driven_body(const StabilityCell& cell, const pbs::Character& character);

}  // namespace experiments
