#include "experiments/studies/work_precision/data_profile.hpp"

#include <algorithm>

namespace experiments {
namespace {

bool counts(const Diagram& diagram, bool with_training)
{
    return is_pose(diagram) && (with_training || diagram.half == Half::evaluation);
}

void add_steps(std::vector<ProfileStep>& steps, const std::vector<const Diagram*>& poses, const DeformerGroup& group, double tolerance_pct)
{
    std::vector<double> times;
    for (const Diagram* pose : poses)
        if (const auto ms = time_to_solve(*pose, group, tolerance_pct)) times.push_back(*ms);
    std::sort(times.begin(), times.end());
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (i + 1 < times.size() && times[i + 1] == times[i]) continue;
        ProfileStep& step = steps.emplace_back(ProfileStep{poses.front()->comparison, tolerance_pct, group.key, times[i]});
        step.solved = static_cast<int>(i + 1);
        step.poses = static_cast<int>(poses.size());
        step.share_pct = 100.0 * step.solved / step.poses;
    }
}

}  // namespace

const analysis::Columns<ProfileStep> data_profile_columns = {
    {"comparison", &ProfileStep::comparison, "", "packed_f32 or plain_f64"},
    {"tolerance_pct", &ProfileStep::tolerance_pct, "%", "largest error at the joints of a pose that counts as solved"},
    {"group", &ProfileStep::group, "", "key of a group of deformers"},
    {"ms", &ProfileStep::ms, "ms", "time per frame from which on so many poses are solved"},
    {"solved", &ProfileStep::solved, "", "number of poses that are solved"},
    {"poses", &ProfileStep::poses, "", "number of evaluated poses"},
    {"share_pct", &ProfileStep::share_pct, "%", "share of the poses that are solved"}};

std::optional<double> time_to_solve(const Diagram& diagram, const DeformerGroup& group, double tolerance_pct)
{
    std::optional<double> least_ms;
    std::vector<std::size_t> indices;
    for (const analysis::WorkPrecision& point : diagram.of(group.deformers, indices))
        if (point.error <= tolerance_pct && (!least_ms || point.cost < *least_ms)) least_ms = point.cost;
    return least_ms;
}

std::vector<ProfileStep> data_profiles(const std::vector<Diagram>& diagrams)
{
    std::vector<ProfileStep> steps;
    for (const Comparison comparison : comparisons) {
        std::vector<const Diagram*> poses;
        for (const Diagram& diagram : diagrams)
            if (diagram.comparison == comparison && counts(diagram, false)) poses.push_back(&diagram);
        for (const double tolerance_pct : profile_tolerances_pct)
            for (const DeformerGroup& group : groups_of(diagrams)) add_steps(steps, poses, group, tolerance_pct);
    }
    return steps;
}

Solved solved_within(const std::vector<Diagram>& diagrams, Comparison comparison, const DeformerGroup& group, double tolerance_pct,
                     double ms, const std::string& body, bool with_training)
{
    Solved count;
    for (const Diagram& diagram : diagrams) {
        if (diagram.comparison != comparison || !counts(diagram, with_training)) continue;
        if (!body.empty() && diagram.pose.body != body) continue;
        ++count.poses;
        const std::optional<double> least_ms = time_to_solve(diagram, group, tolerance_pct);
        count.solved += least_ms && *least_ms <= ms;
    }
    return count;
}

}  // namespace experiments
