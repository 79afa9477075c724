#include "experiments/studies/features/feature_cost.hpp"

#include "analysis/frame_metrics.hpp"
#include "experiments/scene/motion_case.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/own_process.hpp"
#include "analysis/records/kept_record.hpp"
#include "experiments/process/progress.hpp"
#include "experiments/run/run.hpp"
#include "pbs/solver/options.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// A terminal of its own for stderr, so that the bar is drawn and seen by nobody.
void draw_progress_unseen()
{
    const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0) throw std::runtime_error("no terminal to draw a bar on");
    const int slave = open(ptsname(master), O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (slave < 0 || dup2(slave, STDERR_FILENO) < 0) throw std::runtime_error("no terminal to draw a bar on");
    show_progress();
}

nlohmann::json run_and_tell(const Scene& scene, const Variant& variant, const std::string& folder)
{
    if (variant.progress) draw_progress_unseen();
    run_scene(scene, folder);
    return analysis::from_record((fs::path(folder) / "run.json").string(), [](const nlohmann::json& run) {
        nlohmann::json cost = run.at("cost");
        cost["frames"] = run.at("outcome").at("frames");
        cost["breakdown"] = run.at("outcome").at("breakdown");
        return cost;
    });
}

const DeformerSpec& pbs_of(const Scene& scene)
{
    const DeformerSpec* pbs = find_deformer_with<pbs::PbsOptions>(scene);
    if (!pbs) throw std::logic_error("a scene without PBS");
    return *pbs;
}

// Seconds before the first frame.
double start_of(const nlohmann::json& seconds)
{
    double sum = 0.0;
    for (const char* part : {"character", "motion", "set_up", "ruler_set_up", "error_bar_set_up"}) sum += seconds.value(part, 0.0);
    return sum;
}

}  // namespace

SceneCost cost_of(const Scene& scene, const Variant& variant, const std::string& scratch_folder)
{
    const nlohmann::json cost = in_own_process([&] { return run_and_tell(scene, variant, scratch_folder); });
    const nlohmann::json &seconds = cost.at("seconds"), &cpu_seconds = cost.at("cpu_seconds");
    const double ms_a_frame = 1e3 / cost.at("frames").get<double>();
    const auto step_of = [&](const nlohmann::json& parts) {
        return ms_a_frame * parts.at("deformers").at(pbs_of(scene).label).at("step").get<double>();
    };
    SceneCost result;
    result.start_s = start_of(seconds);
    result.frame_ms = ms_a_frame * (seconds.at("total").get<double>() - start_of(seconds));
    result.frame_cpu_ms = ms_a_frame * (cpu_seconds.at("total").get<double>() - start_of(cpu_seconds));
    result.step_ms = step_of(seconds);
    result.step_cpu_ms = step_of(cpu_seconds);
    result.peak_mb = cost.at("peak_memory_mb").get<double>();
    result.shared_objects = cost.at("shared_objects").get<int>();
    result.breakdown = cost.at("breakdown").get<std::string>();
    return result;
}

AnswerChange change_between(const Scene& without, const Scene& with)
{
    const pbs::Character character = pbs::make_character(without.character);
    const pbs::Motion motion = make_motion(without.motion, character.skeleton, without.file);
    const analysis::Ruler ruler(character.mesh.rest, character.mesh.tets);
    const auto before = make_deformer(pbs_of(without)), after = make_deformer(pbs_of(with));
    before->reset(character);
    after->reset(character);
    AnswerChange change;
    for (const pbs::Pose& pose : motion.steps) {
        before->advance(pose, motion.time_step_s);
        after->advance(pose, motion.time_step_s);
        const double distance = (before->positions() - after->positions()).rowwise().norm().maxCoeff();
        const double volume = ruler.measure(before->positions()).volume_change_pct - ruler.measure(after->positions()).volume_change_pct;
        change.distance_m = std::max(change.distance_m, distance);
        change.volume_difference_pct = std::max(change.volume_difference_pct, std::abs(volume));
    }
    return change;
}

}  // namespace experiments
