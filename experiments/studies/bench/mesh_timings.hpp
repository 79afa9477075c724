// Everything that is timed on one body.
#pragma once

#include "experiments/studies/bench/bench_body.hpp"
#include "experiments/studies/bench/machine_limits.hpp"
#include "experiments/process/peak_memory.hpp"
#include "experiments/studies/bench/projection_timing.hpp"
#include "experiments/studies/bench/skinning_timing.hpp"

#include <optional>

namespace experiments {

// The reference on the same tets (linear elasticity, P1, bones embedded): the first frame with all its set-up, and every further one. One
// thread's processor time; the BLAS is held to one.
struct FemTiming {
    std::string model = "linear";
    int element_order = 1;
    Spread ms_first_solve;    // elements, stiffness, elimination, symbolic analysis, factor, solve
    Spread ms_further_frame;  // loads of another pose, and a solve
    double further_to_first = 0.0;
};

struct MeshTimings {
    std::string name;
    int vertices = 0, edges = 0, tets = 0;
    std::vector<ProjectionTiming> projections;
    std::vector<SkinningTiming> skinning;
    std::optional<FemTiming> fem;
    std::string fem_left_out;  // why, where there is none
    PeakMemory memory;         // of one step of `ordered` in f32: solver and all

    double constraints() const { return double(vertices) + edges + tets; }
};

struct MeshTimingOptions {
    std::vector<int> threads = {1};
    Rounds rounds = {};
    bool fem = true;
};

MeshTimings time_mesh(const BenchBody& body, const MachineLimits& limits, const MeshTimingOptions& options);

// {"mesh", "results", "yardsticks", "skinning", "fem", "memory"}
nlohmann::json json_of(const MeshTimings& timings);

}  // namespace experiments
