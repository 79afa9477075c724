// A character from 2,000 to 1,000,000 tets, end to end: mesh, set-up, LBS and PBS, ruler, frames on disk; seconds of each part and peak
// memory, and how they grow.
//
//   human  MakeHuman's body, 6 frames of the clip's jump, at 600 to 20,000 vertices (--full: to 190,000)
//
// The sizes run one after the other, each in a process of its own with nothing beside it, and mesh anew. Writes
// DIR/scale/sizes/VERTICES/... (a run's directory), DIR/scale/scale.csv and scale.md.
#include "analysis/records/atomic_file.hpp"
#include "experiments/process/own_process.hpp"
#include "analysis/records/kept_record.hpp"
#include "experiments/run/run.hpp"
#include "experiments/studies/scale/scale_table.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

Scene human_of(int vertices)
{
    return read_scene("human_01_01", {"character.vertices=" + std::to_string(vertices), "motion.start_s=1.6", "motion.duration_s=0.05",
                                      R"(deformers.use=["lbs", "pbs"])", R"(reference.name="")", "output.frames_every=1",
                                      "output.frames=[]", "output.frame_names=[]"});
}

ScaleRow row_of(const fs::path& folder)
{
    const analysis::CsvTable metrics = analysis::read_csv((folder / "metrics.csv").string());
    return analysis::from_record((folder / "run.json").string(), [&](const nlohmann::json& run) { return scale_row(run, metrics); });
}

std::string run_sizes(const std::vector<int>& sizes, const std::string& folder)
{
    const fs::path cache = fs::path(folder) / "cache";
    std::vector<ScaleRow> rows;
    std::string breakdown;
    for (const int vertices : sizes) {
        const fs::path run = fs::path(folder) / std::to_string(vertices);
        fs::remove_all(cache);
        const nlohmann::json told = in_own_process([&] {
            setenv("PBSKIN_CACHE", cache.c_str(), 1);
            return nlohmann::json(run_scene(human_of(vertices), run.string()).failure());
        });
        if (!told.get<std::string>().empty()) breakdown += fmt::format("{} vertices: {} ", vertices, told.get<std::string>());
        rows.push_back(row_of(run));
        spdlog::info("{} tets: {:.3g} ms a step, {:.3g} s in all", rows.back().tets, rows.back().step_ms, rows.back().total_s);
    }
    fs::remove_all(cache);
    scale_csv(rows).write((fs::path(folder) / "scale.csv").string());
    return breakdown;
}

StudyPlan plan(bool full)
{
    std::vector<int> sizes = {600, 2400, 7000, 20000};
    if (full) sizes.insert(sizes.end(), {60000, 190000});
    StudyPlan plan;
    try {
        plan.runs.push_back({.name = "sizes",
                             .cost_s = full ? 500.0 : 60.0,
                             .work = [sizes](const std::string& folder) { return run_sizes(sizes, folder); },
                             .settings = {{"scene", resolved_with_deformers(human_of(sizes.front()))}, {"vertices", sizes}}});
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"scale: nothing ran\n", false};
    const analysis::CsvTable table = finished.gathered("scale.csv");
    finished.write("scale.csv", table);
    const std::string text = scale_markdown(table);
    finished.write("scale.md", text);
    return {text, true};
}

}  // namespace

Study scale_study()
{
    return {"scale", plan, when_named, conclude, true};
}

}  // namespace experiments
