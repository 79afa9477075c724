// The parts of run.json that are the same for all runs.
//   run["provenance"] = run_provenance(threads);   run["outcome"].update(run_end(stopwatch.seconds()));
#pragma once

#include "analysis/records/provenance.hpp"

#include <nlohmann/json_fwd.hpp>

namespace experiments {

// The version of run.json. Since 3, errors are measured outside the part of the body that overlaps itself, and the outcome counts the
// frames with such a part (frames_with_overlap, largest_masked_share_pct) instead of leaving them out.
inline constexpr int run_schema = 3;

// The provenance of this build and machine, with the BLAS in use and the versions of the libraries that make characters and frames (empty
// for a library that the build left out). threads: that the run uses.
analysis::Provenance run_provenance(int threads);

// ended_utc: now, as ISO 8601 to the second; wall_s: as given [s].
nlohmann::json run_end(double wall_s);

}  // namespace experiments
