// The points of one case of the work-precision study: the time and the work per frame and the error of every setting in one pose.
//   const MeasuredPoints points = measure_points(of);
//   table_of(point_columns, points.rows).write("points.csv");
// The reference is that of shared/posed_reference.hpp, with its bound. Errors are measured outside the part of the body that
// overlaps itself and, as one more column, on the whole body. A point whose error is not above the bound may be as good as the reference
// and is marked. Further references of the family (shared/posed_reference.hpp) decide how far an order of deformers depends on the
// choice of the reference. The error of PBS is split into solver, model and discretisation (error_split/error_split.hpp). A ladder of
// iterations ends where a frame takes longer than the limit. The limit of the deformers that minimise an energy, from which their distance
// is measured, is the point of linear elements with their law on the case's own tets (PointSetting::is_limit_of_deformers).
#pragma once

#include "experiments/studies/work_precision/point_row.hpp"
#include "experiments/studies/work_precision/work_precision_case.hpp"

namespace experiments {

struct MeasuredPoints {
    std::vector<PointRow> rows;
    std::vector<FamilyRow> members;
    std::string breakdown;  // PBS, LBS or a deformer of the user's own that is not finite; a reference that is not reached is recorded as
                            // an outcome
};

// Throws an InputError if a deformer of the user's own fails.
MeasuredPoints measure_points(const WorkPrecisionCase& of);

}  // namespace experiments
