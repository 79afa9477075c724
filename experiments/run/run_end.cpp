#include "experiments/run/run_end.hpp"

#include <fmt/chrono.h>

#include <ctime>

namespace experiments {

nlohmann::json run_end(double wall_s)
{
    return {{"ended_utc", fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)))}, {"wall_s", wall_s}};
}

}  // namespace experiments
