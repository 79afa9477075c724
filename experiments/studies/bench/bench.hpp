// The whole bench: the machine's limits, then every body, then how the cost grows.
//   const BenchRecord record = run_bench({.threads = 2});
//   fmt::print("{}", bench_table(record));
#pragma once

#include "analysis/line_fit.hpp"
#include "experiments/studies/bench/mesh_timings.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

struct BenchOptions {
    std::string mesh;        // a tet mesh file; empty: built-in bars
    bool bars = false;       // the two usual bars, of about 2,200 and 19,500 vertices, also where sizes are asked for
    std::vector<int> sizes;  // bars of so many tets, ascending, and how the cost grows; empty: the two usual bars
    int threads = 1;         // timed beside one thread
    bool quick = false;      // a few milliseconds, to see that it runs: no figure of it is worth anything
    double seconds = 4.0;    // of rounds on each body, about
};

// How the cost of a step grows with the mesh: ms_step = c (number of constraints)^exponent, over bodies of growing size.
struct ScalingFit {
    std::string variant, precision;
    int threads = 1;
    analysis::Interval exponent;  // 95 %; bounds are NaN for two sizes
};

// One a variant, precision and number of threads that all meshes have; none for fewer than two meshes.
std::vector<ScalingFit> fit_scaling(const std::vector<MeshTimings>& meshes);

void to_json(nlohmann::json& json, const ScalingFit& fit);

struct BenchRecord {
    BenchOptions options;
    MachineLimits limits;
    std::vector<MeshTimings> meshes;
    std::vector<ScalingFit> scaling;             // where sizes were asked for
    double load_before = 0.0, load_after = 0.0;  // of the machine: runnable processes, mean of a minute; 1 is this bench alone
};

BenchRecord run_bench(const BenchOptions& options);

// The first body at the top level, as the contract has it, and all of them under "meshes".
nlohmann::json bench_json(const BenchRecord& record);

std::string bench_table(const BenchRecord& record);

// "1K", "20k", "1M", "5000" -> a number of tets; pbs::InputError for anything else.
int parse_size(const std::string& text);

}  // namespace experiments
