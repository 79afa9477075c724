// A scene that runs in a process of its own, so that its peak memory, its loaded libraries and its breakdowns are its own.
//   const nlohmann::json run = run_scene_alone(scene, folder);
//   run.at("cost").at("peak_memory_mb")
#pragma once

#include "experiments/scene/scene.hpp"

#include <functional>
#include <string>

namespace experiments {

// The run.json of the run in `folder`. The new process calls `prepare` first. Errors as in_own_process and run_scene.
nlohmann::json run_scene_alone(const Scene& scene, const std::string& folder, const std::function<void()>& prepare = {});

}  // namespace experiments
