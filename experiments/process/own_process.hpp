// Work in a process of its own, so that its peak memory, its loaded libraries and its breakdowns are its own.
//   const nlohmann::json cost = in_own_process([&] { return cost_of(scene); });
#pragma once

#include <nlohmann/json.hpp>

#include <functional>

namespace experiments {

// What the work returns. An InputError there is one here, with the same words, another exception a std::runtime_error; a signal there is an
// InputError; Interrupted where this process is.
nlohmann::json in_own_process(const std::function<nlohmann::json()>& work);

}  // namespace experiments
