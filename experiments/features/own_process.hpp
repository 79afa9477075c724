// Work in a process of its own, so that its peak memory, its loaded libraries and its breakdowns are its own.
//   const nlohmann::json cost = in_own_process([&] { return cost_of(scene); });
#pragma once

#include <nlohmann/json.hpp>

#include <functional>

namespace experiments {

// What the work returns. InputError with its words for an exception or a signal there; Interrupted where this process is.
nlohmann::json in_own_process(const std::function<nlohmann::json()>& work);

}  // namespace experiments
