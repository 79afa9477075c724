// Two goals of a deformer for characters, judged pose by pose, training poses included. The diagrams show the chosen settings, so that a
// training pose is not independent of its setting.
//   const std::vector<GoalRow> rows = goal_rows(diagrams);   // up to three rows per comparison and pose
// The whole method: an error of at most 5 % at the joints within 3 ms per frame. A deformer that minimises the reference's energy with
// linear elements cannot be nearer than these elements are. Their error on the case's own tets is therefore a column, and the second row
// has the fastest point on any mesh that reaches the 5 %.
// The solver alone: a distance of at most 1 % from these linear elements within 6 ms, and the time that Newton's method takes for them.
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

inline constexpr double goal_pct = 5.0, goal_ms = 3.0;
inline constexpr double solver_goal_pct = 1.0, solver_goal_ms = 6.0;

enum class GoalPoint { nearest_within_time, fastest_within_error, fastest_to_linear_elements };

struct GoalRow {
    Comparison comparison = Comparison::packed_f32;
    std::string diagram;
    Half half = Half::evaluation;
    std::optional<double> linear_elements_pct = {}, newton_ms = {};  // of linear elements; nothing where they have no error or no time
    GoalPoint which = GoalPoint::nearest_within_time;
    DiagramPoint point;
    bool reaches_goal = false;
};
extern const analysis::Columns<GoalRow> goal_columns;  // goal.csv

// Poses without a reference have no rows, and means over several poses have none. A row is missing where no point fulfils its condition.
std::vector<GoalRow> goal_rows(const std::vector<Diagram>& diagrams);

// Markdown for readers: the number of poses of each body that each group of deformers solves, and the rows of both goals.
std::string goal_text(const std::vector<Diagram>& diagrams, Comparison comparison);

}  // namespace experiments

namespace analysis {

template <>
struct EnumNames<experiments::GoalPoint> {
    static constexpr std::array<std::pair<experiments::GoalPoint, const char*>, 3> table{
        {{experiments::GoalPoint::nearest_within_time, "nearest_within_time"},
         {experiments::GoalPoint::fastest_within_error, "fastest_within_error"},
         {experiments::GoalPoint::fastest_to_linear_elements, "fastest_to_linear_elements"}}};
};

}  // namespace analysis
