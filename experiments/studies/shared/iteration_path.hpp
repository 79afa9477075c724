// Lines 10-14 of Algorithm 1 iterated far past the paper's 24, from any start, and what is seen on the way. Every figure is measured on
// positions by the ruler of all records, none is taken from the solver.
//   const IterationRuler ruler(character, bind_points);
//   const std::vector<IterationPath> paths = iterate(character, options, bind_points, starts, 1000, ruler);
#pragma once

#include "analysis/frame_metrics.hpp"
#include "pbs/character/character.hpp"
#include "pbs/solver/options.hpp"

#include <functional>
#include <vector>

namespace experiments {

struct Look {
    int iteration = 0;         // 0: the start itself
    double stretch_rms = 0.0;  // rms of l / l0 - 1 over the edges
    double volume_rms = 0.0;   // rms of V / V0 - 1 over the tets
    double bind_rms_m = 0.0;   // rms of |x_i - q_i| - d_i over the vertices [m]
    double combined = 0.0;     // sqrt((stretch_rms^2 + volume_rms^2 + (bind_rms_m / mean d)^2) / 3): one figure for all three classes
    double volume_change_pct = 0.0, volume_abs_change_pct = 0.0;
    int inverted_tets = 0;
    double error_joint_pct = 0.0;  // to the reference, at the joints; not a number where there is none
};

struct IterationPath {
    std::vector<Look> looks;  // by iteration; the last one is at the last iteration, or where positions ceased to be finite
    pbs::Positions last;      // [m], #V x 3
    bool finite = true;
    double iteration_ms = 0.0;  // mean processor time of an iteration, looks left out
};

class IterationRuler {
public:
    using ErrorPct = std::function<double(const pbs::Positions&)>;  // to the reference

    IterationRuler(const pbs::Character& character, const pbs::Positions& bind_points, ErrorPct error = {});
    Look measure(int iteration, const pbs::Positions& positions) const;

private:
    analysis::Ruler ruler_;
    pbs::Positions bind_points_;
    Eigen::VectorXd bind_distance_;
    ErrorPct error_;
};

// Every iteration up to the 64th, then steps of two per cent; 0 and `most` among them.
std::vector<int> looked_at(int most);

// One path a start; options.iterations and options.jiggle do not count.
std::vector<IterationPath> iterate(const pbs::Character& character, const pbs::PbsOptions& options, const pbs::Positions& bind_points,
                                   const std::vector<pbs::Positions>& starts, int most, const IterationRuler& ruler);

}  // namespace experiments
