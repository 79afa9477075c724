// Lines 10-14 of Algorithm 1 iterated far past the paper's 24 iterations, from any initial guess. Each look at the
// positions on the way is measured by the metrics of all records; no value is taken from the solver.
//   const IterationMetrics iteration_metrics(character, bind_points);
//   const std::vector<IterationPath> paths = iterate(character, options, bind_points, starts, 1000, metrics);
//   // reached.iterations, or more than those where !reached.within
//   const Reached reached = reached_residual(paths[0], floor_of(paths));
// The constraints contradict each other, so a residual does not go to zero. A path has arrived by one of two
// tolerances:
// - residual: the combined residual (Look::combined) is within 5 % of its floor, which is the lowest residual that any
//   of the initial guesses has after the last iteration; or it is below 1e-4, where the constraints can be satisfied
//   and the floor is rounding (no constraint feels a twist);
// - volume: the absolute volume change is within the paper's 0.5 % (analysis::kept_volume_pct).
// The number of iterations is the first one after which the path never leaves the tolerance again.
#pragma once

#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/characters/character.hpp"
#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/options.hpp"
#include "pbs/solver/projection.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace experiments {

class PosedReference;

struct Look {
    int iteration = 0;         // 0: the initial guess
    double stretch_rms = 0.0;  // rms of l / l0 - 1 over the edges
    double volume_rms = 0.0;   // rms of V / V0 - 1 over the tets
    double bind_rms_m = 0.0;   // rms of |x_i - q_i| - d_i over the vertices [m]
    double combined =
        0.0;  // sqrt((stretch_rms^2 + volume_rms^2 + (bind_rms_m / mean d)^2) / 3): one number for all three classes
    double volume_change_pct = 0.0, volume_abs_change_pct = 0.0;
    int inverted_tets = 0;
    // To the reference at the joints, outside the tips of its creases and on the whole body; not a number where there
    // is no reference.
    double error_joint_pct = 0.0, whole_joint_pct = 0.0;
};

struct IterationPath {
    // by iteration; the last one is at the last iteration, or where positions ceased to be finite
    std::vector<Look> looks;
    pbs::Positions last;  // [m], #V x 3
    bool finite = true;
};

class IterationMetrics {
public:
    // reference: null where there is none.
    IterationMetrics(const pbs::Character& character, const pbs::Positions& bind_points,
                     const PosedReference* reference = nullptr);
    Look measure(int iteration, const pbs::Positions& positions) const;

private:
    analysis::MeshMetrics mesh_metrics_;
    pbs::Positions bind_points_;
    Eigen::VectorXd bind_distance_;
    const PosedReference* reference_;
};

// Every iteration up to the 64th, then steps of two per cent. 0 and `most` are among them.
std::vector<int> looked_at(int most);

// One path per initial guess. options.iterations and options.jiggle are ignored.
std::vector<IterationPath> iterate(const pbs::Character& character, const pbs::PbsOptions& options,
                                   const pbs::Positions& bind_points, const std::vector<pbs::Positions>& starts,
                                   int most, const IterationMetrics& iteration_metrics);

// The parts of a step of Algorithm 1: `load` puts the particles at the initial guess, an iteration projects bind,
// stretch and volume, and `store` gives positions [m], #V x 3, which are valid until it is called again.
struct StepLoops {
    std::function<void()> load, bind, stretch, volume;
    std::function<const pbs::Positions&()> store;
    std::function<pbs::Residuals()> residuals;
    // share of lanes that hold a constraint, of the batched orders
    std::optional<double> stretch_fill = {}, volume_fill = {};

    void iterate() const
    {
        bind();
        stretch();
        volume();
    }
};

// The initial guess and the posed bind points [m], #V x 3, which each `load` reads and which outlive the loops.
struct StepStart {
    const pbs::Positions &guess, &bind_points;
    bool has_local_origin = true;  // positions are relative to pbs::local_origin; false: to the origin of the world
};

template <typename Scalar>
StepLoops step_loops(const pbs::ConstraintSet<Scalar>& constraints, const pbs::Tets& tets,
                     const pbs::PbsOptions& options, const StepStart& start);

// The path of one initial guess, which `loops` load.
IterationPath follow(const StepLoops& loops, const pbs::Positions& guess, int most,
                     const IterationMetrics& iteration_metrics);

inline constexpr int paper_iterations = 24;         // of a step
inline constexpr double residual_tolerance = 0.05;  // of the floor
inline constexpr double satisfied_residual = 1e-4;

struct Reached {
    int iterations = 0;
    bool within = false;  // false: the tolerance was not reached after so many iterations
};

// over the paths that stayed finite; not a number where none did
double floor_of(const std::vector<IterationPath>& paths);
Reached reached_residual(const IterationPath& path, double floor);
Reached reached_volume(const IterationPath& path);

// residual_n = floor + c rate^n, up to the iteration from which on the residual stays within 5 % of its last value (it
// stalls). A residual that the second half of the iterations changes by more than 1 % has not stalled: then the floor
// is that of all initial guesses, and the fit goes to the end. There is no rate where the last residual is rounding.
// least squares of log(residual_n - floor); not a number: none
double rate_of(const IterationPath& path, double floor);

const Look& look_at(const IterationPath& path, int iteration);  // the last look that is not after the iteration
const Look& nearest_to_reference(const IterationPath& path);    // the look with the least error_joint_pct

// Lists the edges and tets of a constraint set in a random sequence, which depends on the seed alone: it is the same on
// every machine and for float and double. Order `plain` projects in this sequence, and the batched orders derive theirs
// from it.
//   pbs::ConstraintSet<float> constraints = pbs::make_constraint_set<float>(...);   // in file order
//   in_random_sequence(constraints, 1);
template <typename Scalar>
void in_random_sequence(pbs::ConstraintSet<Scalar>& constraints, unsigned seed);

}  // namespace experiments
