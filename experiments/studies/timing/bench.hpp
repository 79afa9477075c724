// `pbskin bench`: every order of projection in each precision and number of threads, and every deformer, relative to
// plain loops in the same run; how the cost grows with the mesh.
//   const nlohmann::json record = run_bench({.threads = 2});
//   fmt::print("{}", bench_table(record));
// The record is JSON from the start, since programs read it: README.md lists its members.
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "pbs/solver/step_summary.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct DeformerKind;

// The body and the pose of every value: a twist of 90 degrees about the mesh's longest axis.
//   bar:  [-1, 1] x [-0.15, 0.15]^2 m     held o=======o=======o 90 degrees
struct BenchBody {
    pbs::Character character;         // two bones of equal length along the axis, Eq. 2's weights
    pbs::Positions twisted = {};      // turned by an angle that grows linearly along the axis [m], #V x 3
    pbs::Positions bind_points = {};  // on the axis, which does not move [m], #V x 3
    std::vector<bool> held = {};      // the first 2.5 % of the length, #V
    pbs::Pose pose = {};              // the second bone turned by 90 degrees
    int edges = 0;

    const pbs::TetMesh& mesh() const { return character.mesh; }
};

// The mesh with these bones and Eq. 2's weights.
pbs::Character skinned_along(const std::string& name, pbs::TetMesh mesh, pbs::Skeleton skeleton);

BenchBody make_bench_body(const std::string& name, pbs::TetMesh mesh);

// The built-in bar with about so many vertices, or tets. Beyond 150,000 tets it is the bar with an eighth of them, each
// cut into eight.
BenchBody bench_bar(int vertices);
BenchBody bench_bar_of_tets(int tets);

// Bytes per second read and written by one core within its caches and memory: the larger one of a copy and of an update
// in place. Beyond the first cache a copy is the slower one, because the processor also loads the lines that the copy
// overwrites.
struct MemoryBandwidth {
    double bytes = 0.0;  // working set
    double gb_s = 0.0;   // read and written, 1e9 bytes per second
};

// The best of three turns of about `seconds` of processor time each, since a limit is reached only undisturbed. Working
// sets double from 16 KiB to `largest_bytes`, which should be well beyond the last cache.
std::vector<MemoryBandwidth> measure_bandwidth(double seconds, double largest_bytes = 256e6);

// Interpolates linearly in the logarithm of the working set; constant outside the measured sizes.
double bandwidth_at(const std::vector<MemoryBandwidth>& memory, double bytes);

// plain, ordered: the orders. poses: sixteen poses per thread side by side.
// Two baselines for comparison with `plain`, which gives the same bits on every machine. plain_native has the same
// loops with all that the compiler offers. plain_spread has those loops on constraints whose neighbours in the list lie
// far apart in the mesh, so that no projection waits for the stores of the one before (sorted edges share their first
// vertex with their neighbours): the best that plain loops can do.
struct ProjectionVariant {
    std::string variant, precision;  // precision: f32, f64
    int threads = 1;
    int poses = 1;         // that one step projects side by side
    StepLoops loops = {};  // the particles begin at the twisted positions

    double scalar_bytes() const { return precision == "f32" ? 4.0 : 8.0; }
};

// The loops of sixteen poses per thread, all the same one, in the order `ordered`.
template <typename Scalar>
StepLoops loops_of_poses(const pbs::ConstraintSet<Scalar>& constraints, const pbs::Tets& tets,
                         const pbs::PbsOptions& options, const StepStart& start, int threads);

// All variants for one thread, and those that know threads for the other numbers of threads.
std::vector<ProjectionVariant> projection_variants(const BenchBody& body, const std::vector<int>& threads);

// The answer after the step over that of plain loops after theirs, on the same body and in the same precision; above 1:
// a loss.
struct AnswerRatio {
    double residual =
        0.0;  // combined: sqrt((stretch_rms^2 + volume_rms^2 + (bind_rms / mean rest distance to the bone)^2) / 3)
    double volume_rms = 0.0;  // rms of V / V0 - 1
};
AnswerRatio answer_ratio(const pbs::Residuals& own, const pbs::Residuals& plain, double mean_distance_m);

// A list with an entry per variant. One thread is measured in its processor time, several threads in wall time. The
// transfer of positions into an order's own layout and back is reported separately (ms_transfer).
nlohmann::json time_projections(const BenchBody& body, const std::vector<int>& threads,
                                const std::vector<MemoryBandwidth>& memory, const Rounds& rounds);

// A deformer's kind with one choice of its options. The plain one is in f64, or in the order `plain`.
struct DeformerSetting {
    DeformerSpec spec;
    std::optional<DeformerSpec> twice;  // with twice the iterations; nothing if it has no key `iterations`
    // order: that of the key, or `packed` or `plain` of a kind with the key `packed`; empty without either key.
    // precision: that of its traits without a key.
    std::string order, precision;
    std::size_t plain = 0;  // its place in the list of the kind's settings
};

// One per value of `order`, `precision` and `packed`, of which plain code has f64 alone. The key of a list counts as
// that of its first table.
std::vector<DeformerSetting> deformer_settings(const DeformerKind& kind);

// A list with an entry for each registered deformer in each precision and order that it offers, in processor time of
// one thread, and for the finite elements on linear tets: linear elasticity, and stable neo-Hookean flesh. A deformer
// that the mesh is too large for is left out; one that the build or the body does not allow has the reason in
// `left_out`.
nlohmann::json time_deformers(const BenchBody& body, const Rounds& rounds);

struct BenchOptions {
    std::string mesh;        // a tet mesh file; empty: built-in bars
    bool bars = false;       // the two usual bars, of about 2,200 and 19,500 vertices, as well as the sizes
    std::vector<int> sizes;  // bars with so many tets, ascending, for the growth of the cost; empty: the two usual bars
    int threads = 1;         // timed as well as one thread
    bool quick = false;      // a few milliseconds, to see that it runs; the times are worthless
    double seconds = 4.0;    // of rounds on each body, about
};
nlohmann::json to_json(const BenchOptions& options);

// How the cost of a step grows with the mesh: ms_step = c (number of constraints)^exponent, over bodies of growing
// size. One entry per variant, precision and number of threads that all meshes have; none for fewer than two meshes.
nlohmann::json fit_scaling(const nlohmann::json& meshes);

// The first body at the top level, as the contract has it, and all of them under "meshes".
nlohmann::json run_bench(const BenchOptions& options);
std::string bench_table(const nlohmann::json& record);

// "1K", "20k", "1M", "5000" -> a number of tets; pbs::InputError for anything else.
int parse_size(const std::string& text);

}  // namespace experiments
