// A body that is let go from a displaced shape: its first frequency and damping, from the solver in time (Algorithm 1 as it is).
//   const ReleaseTest test = release({mesh, held, options, shape, tip}, 0.01);
//   test.frequency_hz, test.damping_ratio
#pragma once

#include "analysis/records/tables.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"

#include <vector>

namespace experiments {

struct ReleasedBody {
    pbs::TetMesh mesh;
    std::vector<bool> held;  // #V
    pbs::PbsOptions options;
    pbs::Positions displacement;  // initial [m], #V x 3; held vertices stay at rest
    pbs::Vec3 direction;          // unit; the mean displacement along it is what swings
    std::vector<int> tip;         // of these vertices
};

enum class SwingOutcome { finished, no_crossing, not_finite };  // no_crossing: damped away, or slower than the time that was watched

struct ReleaseTest {
    SwingOutcome outcome = SwingOutcome::finished;
    double frequency_hz = 0.0;   // damped: between the first and the last zero crossing
    double damping_ratio = 0.0;  // from the extremes between them: log decrement
    double undamped_hz = 0.0;    // frequency_hz / sqrt(1 - damping_ratio^2)
    int half_periods = 0, steps = 0;
};

// Zero crossings, times and extremes of a signal sampled every dt_s.
ReleaseTest measure_swing(const std::vector<double>& signal, double dt_s);

// Runs until `half_periods` lie between crossings, at most `most_steps`. All particles that are not held are integrated; bind constraints
// are off, as they would hold the axis.
ReleaseTest release(const ReleasedBody& body, double dt_s, int half_periods = 4, int most_steps = 4000);

}  // namespace experiments

template <>
struct analysis::EnumNames<experiments::SwingOutcome> {
    static constexpr std::array<std::pair<experiments::SwingOutcome, const char*>, 3> table{
        {{experiments::SwingOutcome::finished, "finished"},
         {experiments::SwingOutcome::no_crossing, "no_crossing"},
         {experiments::SwingOutcome::not_finite, "not_finite"}}};
};
