// Which deformer is missing where, and why. Every diagram shows the omissions of its case.
//   for (const Omission& omission : omissions_of(rows_of_all_cases)) ...
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

// The outcomes of points without an answer; no_such_code: the deformer has no code of this comparison; not_run: it has no point in this
// case although it has in others; no_reference: there is no error, since the reference was not reached. Its reason has the worst tet of the
// reference's last state.
struct Omission {
    Comparison comparison = Comparison::packed_f32;
    std::string of = {};  // the case, or the mean over several
    std::string deformer = {};
    std::string why = {};         // not_finite, not_converged, over_time_limit, not_applicable, no_such_code, not_run, no_reference
    int missing = 0, points = 0;  // points that are missing for this reason, of all that the deformer has in the case or mean
    std::string reason = {};      // of the first of them, for readers
};
extern const analysis::Columns<Omission> omission_columns;  // omissions.csv

std::vector<Omission> omissions_of(const std::vector<CaseRows>& cases);

// The omissions of the means among the diagrams: those of their poses added up, of the points in all poses of the mean.
std::vector<Omission> omissions_of_means(const std::vector<CaseRows>& cases, const std::vector<Diagram>& diagrams);

}  // namespace experiments
