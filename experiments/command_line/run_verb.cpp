// pbskin run SCENE.toml [-o DIR] [--set key=value]...: runs one scene and writes frames and records.
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/progress.hpp"
#include "experiments/run/run.hpp"

#include <spdlog/spdlog.h>

namespace experiments {
namespace {

struct RunArguments {
    std::string scene, folder;
    std::vector<std::string> overrides;
};

int run(const RunArguments& arguments, const CommonOptions& common)
{
    if (common.quiet) hide_progress();
    Scene scene = read_scene(arguments.scene, arguments.overrides);
    const std::string folder = arguments.folder.empty() ? "results/" + scene.name : arguments.folder;
    for (DeformerSpec& spec : scene.deformers) spec.threads = common.threads;
    const RunResult result = run_scene(scene, folder);
    for (const auto& line : result.lines) spdlog::info("{}", line);
    spdlog::info("{}: {} frames, {:.1f} s, records in {}", scene.name, result.frames, result.seconds, folder);
    if (!result.breakdown.empty()) spdlog::error("pbskin: numerical breakdown: {}", result.breakdown);
    if (!result.bad_frame.empty()) spdlog::error("pbskin: {}", result.bad_frame);
    return result.failure().empty() ? exit_finished : exit_breakdown;
}

}  // namespace

void add_run_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb = add_verb(app, common, "run", "runs one scene and writes frames and records");
    auto arguments = std::make_shared<RunArguments>();
    verb->add_option("scene", arguments->scene, "a scene file, or the name of a built-in scene")->required();
    verb->add_option("-o,--output", arguments->folder, "folder of the records; by default results/NAME");
    verb->add_option("--set", arguments->overrides, "key=value, e.g. pbs.iterations=96")->allow_extra_args(false);
    verb->callback([&action, &common, arguments] { action = [&common, arguments] { return run(*arguments, common); }; });
}

}  // namespace experiments
