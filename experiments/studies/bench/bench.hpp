// The whole bench: the machine's limits, then every body, then how the cost grows.
//   const BenchRecord record = run_bench({.threads = 2});
//   fmt::print("{}", bench_table(record));
#pragma once

#include "analysis/statistics/fits.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/studies/bench/deformer_timing.hpp"
#include "experiments/studies/bench/newton_timing.hpp"
#include "experiments/studies/bench/projection_timing.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// LBS or DQS, in processor time of one thread: as the paper's Eq. 1 reads (`plain`), or packed for many poses of one body (`packed`).
struct SkinningTiming {
    std::string blend;      // lbs, dqs
    std::string variant;    // plain, packed
    std::string precision;  // f32, f64
    Spread ns_vertex;
    Spread ratio_to_plain;        // plain is in f64
    double gb_s = 0.0;            // rest positions in and posed positions out, which a blend must move at least
    double share_of_limit = 0.0;  // of the bandwidth at that working set
};

// The reference on the same tets (linear elasticity, P1, smooth attachment of the bones): the first frame with its whole set-up, and every
// further frame. Processor time of one thread, to which the BLAS is limited.
struct FemTiming {
    Spread ms_first_solve;    // elements, stiffness, elimination, symbolic analysis, factorisation, solve
    Spread ms_further_frame;  // loads of another pose, and a solve
    double further_to_first = 0.0;
};

struct MeshTimings {
    std::string name;
    int vertices = 0, edges = 0, tets = 0;
    std::vector<ProjectionTiming> projections;
    std::vector<SkinningTiming> skinning;
    std::optional<FemTiming> fem;
    std::optional<NewtonTiming> newton;
    std::string fem_left_out;               // the reason, where the reference could not be timed
    std::vector<DeformerTiming> deformers;  // all that are registered, on meshes of up to 30,000 tets
    PeakMemory memory;                      // of a solver and one step of `ordered` in f32

    double constraints() const { return double(vertices) + edges + tets; }
};

struct MeshTimingOptions {
    std::vector<int> threads = {1};
    Rounds rounds = {};
    bool fem = true;
};

MeshTimings time_mesh(const BenchBody& body, const MachineLimits& limits, const MeshTimingOptions& options);

struct BenchOptions {
    std::string mesh;        // a tet mesh file; empty: built-in bars
    bool bars = false;       // the two usual bars, of about 2,200 and 19,500 vertices, as well as the sizes
    std::vector<int> sizes;  // bars with so many tets, ascending, for the growth of the cost; empty: the two usual bars
    int threads = 1;         // timed as well as one thread
    bool quick = false;      // a few milliseconds, to see that it runs; the times are worthless
    double seconds = 4.0;    // of rounds on each body, about
};
nlohmann::json to_json(const BenchOptions& options);

// How the cost of a step grows with the mesh: ms_step = c (number of constraints)^exponent, over bodies of growing size.
struct ScalingFit : ProjectionKind {
    analysis::Interval exponent;  // 95 %; bounds are NaN for two sizes
};

// One per variant, precision and number of threads that all meshes have; none for fewer than two meshes.
std::vector<ScalingFit> fit_scaling(const std::vector<MeshTimings>& meshes);

struct BenchRecord {
    BenchOptions options;
    MachineLimits limits;
    std::vector<MeshTimings> meshes;
    std::vector<ScalingFit> scaling;                // where sizes were asked for
    std::optional<double> busy_before, busy_after;  // processors that other work kept busy; empty if the system does not report them
};

BenchRecord run_bench(const BenchOptions& options);

// The first body at the top level, as the contract has it, and all of them under "meshes".
nlohmann::json bench_json(const BenchRecord& record);

std::string bench_table(const BenchRecord& record);

// "1K", "20k", "1M", "5000" -> a number of tets; pbs::InputError for anything else.
int parse_size(const std::string& text);

}  // namespace experiments
