#include "experiments/studies/shared/scene_alone.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/run/run.hpp"

namespace experiments {

nlohmann::json run_scene_alone(const Scene& scene, const std::string& folder, const std::function<void()>& prepare)
{
    return in_own_process([&] {
        if (prepare) prepare();
        run_scene(scene, folder);
        return analysis::read_record(analysis::path_in(folder, "run.json"));
    });
}

}  // namespace experiments
