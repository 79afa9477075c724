// The points of one case of the work-precision study: every setting's time a frame and its error against the reference, in one pose.
//   table_of(point_columns, measure_points(of).rows).write("points.csv");
// The reference is stable neo-Hookean flesh on the case's own tets, quadratic where that is asked for and reached, linear otherwise; a
// second solution beside it gives its own error bar (reached_reference.hpp). A point whose error is not above the bar may be as good as the
// reference and is marked. Every error is measured against the second solution as well: what holds against both does not hang on the mesh.
// Of PBS, the error in three parts (error_split/error_split.hpp): solver, model, discretisation.
#pragma once

#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/work_precision/point_row.hpp"

namespace experiments {

struct WorkPrecisionCase {
    std::string body, pose;  // in words: "limb twist", "90 deg"
    Scene scene;             // its character and motion
    int frame = 0;           // of its motion; the one before it is what a frame starts from
    SettingRange range;
    Rounds rounds, newton_rounds;  // of the nonlinear laws, which take seconds a frame; a round that does not arrive is dropped
    int converged_iterations = 8000;
};

nlohmann::json to_json(const WorkPrecisionCase& of);  // all that a run of the study depends on

struct MeasuredPoints {
    std::vector<PointRow> rows;
    std::string breakdown;  // PBS or LBS that is not finite; a reference that is not reached is a result, on record as its outcome
};

MeasuredPoints measure_points(const WorkPrecisionCase& of);

}  // namespace experiments
