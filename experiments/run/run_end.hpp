// When a run ended and how long it took by the clock on the wall, as it stands in run.json under `outcome`.
//   outcome.update(run_end(stopwatch.seconds()));
#pragma once

#include <nlohmann/json.hpp>

namespace experiments {

// ended_utc: ISO 8601, to the second; wall_s: as given.
nlohmann::json run_end(double wall_s);

}  // namespace experiments
