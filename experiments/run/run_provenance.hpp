// The parts of run.json that are the same for all runs.
//   run["provenance"] = run_provenance(threads);   run["outcome"].update(run_end(stopwatch.seconds()));
#pragma once

#include "analysis/records/provenance.hpp"

#include <nlohmann/json_fwd.hpp>

namespace experiments {

// The version of run.json. Since 2, costs of metrics are named after them, and the order of the reference's error bar is called reliable.
inline constexpr int run_schema = 2;

// The provenance of this build and machine, with the BLAS in use and the versions of the libraries that make characters and frames (empty
// for a library that the build left out). threads: that the run uses.
analysis::Provenance run_provenance(int threads);

// ended_utc: now, as ISO 8601 to the second; wall_s: as given [s].
nlohmann::json run_end(double wall_s);

}  // namespace experiments
