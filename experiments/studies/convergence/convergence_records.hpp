// The records of convergence: residuals by iteration, the figures of each path, the way towards the reference.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"

namespace experiments {

// Residuals and volume by iteration, thinned to five looks a decade.
analysis::CsvTable residual_table(const ConvergenceResult& result);
// One row a path: when it is there by both tolerances, in iterations and in processor time as measured there and then, rate, where it
// stalls, how far from the limit that LBS leads to.
analysis::CsvTable rate_table(const ConvergenceResult& result);
// Error to the reference by iteration, thinned likewise.
analysis::CsvTable towards_table(const ConvergenceResult& result);

}  // namespace experiments
