// Work in a process of its own, which has its own peak memory, loaded libraries and breakdowns.
//   const nlohmann::json cost = in_own_process([&] { return cost_of(scene); });
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <functional>

namespace experiments {

// Returns what the work returns. An InputError of the work is thrown here with the same text, any other exception as a
// std::runtime_error. InputError if the process ended by a signal; Interrupted if this process is interrupted.
nlohmann::json in_own_process(const std::function<nlohmann::json()>& work);

}  // namespace experiments
