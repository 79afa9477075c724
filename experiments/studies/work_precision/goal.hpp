// Two goals of a deformer for characters, judged pose by pose, training poses included. The diagrams show the chosen settings, so that a
// training pose is not independent of its setting.
//   const std::vector<GoalRow> rows = goal_rows(diagrams);   // up to four rows per comparison and pose
// The whole method: an error of at most 5 % at the joints within 3 ms per frame. The error of the reference's law with linear elements on
// the case's own tets, by Newton's method, shows what these tets allow. A deformer that minimises an energy has another law, and linear
// elements with that law may have a smaller or larger error. Before it converges, it may have a smaller error than its limit. Where the
// reference's linear elements are above 5 %, a row has the best point on a finer mesh. The bound on the reference's own error decides
// whether a goal that is reached is certain. The solver alone: a distance of at most 1 % at the joints from the own limit of the deformers
// that minimise an energy, within 6 ms and within a thirtieth of the time that Newton's method takes to the same distance. Finite elements
// do not count. This limit is linear elements with their law (Macklin and Mueller's neo-Hookean, pbs/flesh/flesh_energy.hpp) on the
// case's own tets. Newton's method begins at its fastest cold start (newton_way.hpp), as these deformers do in every frame. Its time from
// the solution of the frame before is stated for comparison.
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

inline constexpr double goal_pct = 5.0, goal_ms = 3.0;
inline constexpr double solver_goal_pct = newton_goal_pct, solver_goal_ms = 6.0;
inline constexpr double solver_goal_speed_up = 30.0;  // over Newton's method

enum class GoalPoint { nearest_within_time, fastest_within_error, best_on_finer_mesh, fastest_to_linear_elements };

struct GoalRow {
    Comparison comparison = Comparison::packed_f32;
    std::string diagram;
    Half half = Half::evaluation;
    std::optional<double> linear_elements_pct = {};  // error of linear elements with the reference's law
    std::optional<double> own_limit_pct = {};        // error of those with the deformers' law
    std::optional<double> newton_converged_ms = {};  // time per frame of Newton's method for those
    std::optional<double> newton_goal_ms = {};       // from a cold start to within 1 % of them
    std::optional<NewtonStart> newton_start = {};
    std::optional<double> newton_warm_ms = {};  // likewise from the solution of the frame before
    GoalPoint which = GoalPoint::nearest_within_time;
    DiagramPoint point;
    std::optional<double> reference_error_pct = {};  // bound
    bool reaches_goal = false, is_certain = false;
};
extern const analysis::Columns<GoalRow> goal_columns;  // goal.csv

// The points of a law with linear elements on the case's own tets. Null where the diagram does not have it.
const DiagramPoint* linear_elements_of(const Diagram& diagram);  // the reference's law
const DiagramPoint* own_limit_of(const Diagram& diagram);        // that of the deformers that minimise an energy

// Poses without a reference have no rows, and means over several poses have none. A row is missing where no point fulfils its condition.
std::optional<GoalRow> goal_row(const Diagram& diagram, GoalPoint which);
std::vector<GoalRow> goal_rows(const std::vector<Diagram>& diagrams);

// The poses of a body in which a point of the group reaches the goal of the solver.
struct SolverSolved {
    int solved = 0, poses = 0;
    int in_time = 0;  // within 1 % in 6 ms, whatever Newton's time is
    int unknown = 0;  // Newton's time is not known, and the goal is not counted as reached
};
SolverSolved solver_goal_reached(const std::vector<Diagram>& diagrams, Comparison comparison, const DeformerGroup& group,
                                 const std::string& body);

// Markdown for readers: the number of poses of each body in which each group of deformers reaches each goal, and the rows of both goals.
std::string goal_text(const std::vector<Diagram>& diagrams, Comparison comparison);

}  // namespace experiments

namespace analysis {

template <>
struct EnumNames<experiments::GoalPoint> {
    static constexpr std::array<std::pair<experiments::GoalPoint, const char*>, 4> table{
        {{experiments::GoalPoint::nearest_within_time, "nearest_within_time"},
         {experiments::GoalPoint::fastest_within_error, "fastest_within_error"},
         {experiments::GoalPoint::best_on_finer_mesh, "best_on_finer_mesh"},
         {experiments::GoalPoint::fastest_to_linear_elements, "fastest_to_linear_elements"}}};
};

}  // namespace analysis
