// Newton's method on its way to the limit of the deformers that minimise the energy of elastic flesh: linear elements on the case's own
// tets with their law (pbs/flesh/flesh_energy.hpp). The recorded time is the time to the distance of 1 % that the goal requires of these
// deformers (goal.hpp).
//   const std::vector<NewtonRow> rows = newton_way(of, flesh, mesh, poses, limit, reference);
//   if (const auto newton = fastest_to_goal(rows)) newton->ms_median ...
// The initial guess is replaced, and Newton's method is solved at once in the case's pose: no load path, a new factor in each step. It
// begins at each of the initial guesses that these deformers have. The third cold start is rest, from where the bones are led to the pose
// in stages of at most 45 degrees until it converges. The solution of the frame before is no cold start and is recorded for comparison.
// The matrix's pattern is analysed before the time begins, except from rest. The time contains that of the initial guess where it is
// computed, as the time of the deformers does.
#pragma once

#include "experiments/studies/work_precision/posed_deformer.hpp"
#include "experiments/studies/work_precision/work_precision_case.hpp"

#include <functional>

namespace experiments {

inline constexpr double newton_goal_pct = 1.0;  // distance from the limit at the joints

enum class NewtonStart { smooth_dqs, lbs, rest, frame_before };
inline bool is_cold(NewtonStart start)
{
    return start != NewtonStart::frame_before;
}

struct NewtonRow {
    analysis::CaseKey of = {};
    NewtonStart start = NewtonStart::smooth_dqs;
    int newton_steps = 0;                        // from the start to this state
    std::optional<double> single_steps_ms = {};  // the sum over these steps, each solved alone, which costs one more gradient per step
    std::optional<double> ms_median = {};        // of the first state within the goal alone: guess_ms and the median of whole solves
    double to_limit_pct = 0.0;                   // at the joints
    std::optional<double> guess_ms = {};         // of the initial guess, which is part of ms_median; nothing where none is computed
    std::optional<int> timed_steps = {};         // of the whole solves behind ms_median, which may need more steps than single steps
};
extern const analysis::Columns<NewtonRow> newton_columns;  // newton.csv

// flesh: linear elements with the deformers' law. limit: their solution in the pose [m], #V x 3. mesh: the case's own.
std::vector<NewtonRow> newton_way(const WorkPrecisionCase& of, const PointSetting& flesh, const BodyMesh& mesh, const PosePair& poses,
                                  const pbs::Positions& limit, const PosedReference& reference);

// The fewest steps after which a whole solve is within the goal: `first`, or up to 5 more. Nothing where none of these is.
std::optional<int> steps_to_goal(int first, const std::function<double(int)>& distance_pct_after);

// The least time of a cold start to a state within the goal, or that from the frame before. Nothing where no time above 0 is known.
std::optional<NewtonRow> fastest_to_goal(const std::vector<NewtonRow>& rows);
std::optional<double> warm_to_goal_ms(const std::vector<NewtonRow>& rows);

}  // namespace experiments

namespace analysis {

template <>
struct EnumNames<experiments::NewtonStart> {
    static constexpr std::array<std::pair<experiments::NewtonStart, const char*>, 4> table{
        {{experiments::NewtonStart::smooth_dqs, "smooth_dqs"},
         {experiments::NewtonStart::lbs, "lbs"},
         {experiments::NewtonStart::rest, "rest"},
         {experiments::NewtonStart::frame_before, "frame_before"}}};
};

}  // namespace analysis
