// One step of one order, precision and number of threads, in the parts that are timed.
#pragma once

#include "experiments/studies/bench/bench_body.hpp"
#include "pbs/solver/step_summary.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// `load` puts the particles at the twisted positions, 24 iterations repeat the three classes, and `store` gives positions back.
struct StepLoops {
    std::function<void()> load, bind, stretch, volume, store;
    std::function<pbs::Residuals()> residuals;
};

// plain, ordered, grouped: the orders. poses: sixteen poses per thread side by side, here all the same one.
// Two baselines for comparison with `plain`, which gives the same bits on every machine. plain_native has the same loops with all that the
// compiler offers. plain_spread has those loops on constraints whose neighbours in the list lie far apart in the mesh, so that no
// projection waits for the stores of the one before (sorted edges share their first vertex with their neighbours): the best that plain
// loops can do.
struct ProjectionKind {
    std::string variant;
    std::string precision;  // f32, f64
    int threads = 1;

    bool operator==(const ProjectionKind&) const = default;
};

struct ProjectionVariant : ProjectionKind {
    int poses = 1;  // that one step projects side by side
    StepLoops loops = {};
    std::optional<double> stretch_fill = {}, volume_fill = {};  // share of lanes that hold a constraint, of the batched orders

    double scalar_bytes() const { return precision == "f32" ? 4.0 : 8.0; }
};

// All variants for one thread, and those that know threads for the other numbers of threads.
std::vector<ProjectionVariant> projection_variants(const BenchBody& body, const std::vector<int>& threads);

}  // namespace experiments
