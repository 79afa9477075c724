#include "experiments/studies/work_precision/data_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace experiments {
namespace {

bool counts(const Diagram& diagram)
{
    return is_pose(diagram) && diagram.half == Half::evaluation;
}

void add_steps(std::vector<ProfileStep>& steps, const std::vector<const Diagram*>& poses, const DeformerGroup& group, double tolerance_pct)
{
    std::vector<double> solved, certain;
    for (const Diagram* pose : poses) {
        if (const auto ms = time_to_solve(*pose, group, tolerance_pct)) solved.push_back(*ms);
        if (const auto ms = time_to_solve_certainly(*pose, group, tolerance_pct)) certain.push_back(*ms);
    }
    std::set<double> times(solved.begin(), solved.end());
    times.insert(certain.begin(), certain.end());
    const auto until = [](const std::vector<double>& of, double ms) {
        return static_cast<int>(std::ranges::count_if(of, [&](double one) { return one <= ms; }));
    };
    for (const double ms : times) {
        ProfileStep& step = steps.emplace_back(ProfileStep{poses.front()->comparison, tolerance_pct, group.key, ms});
        step.solved = until(solved, ms);
        step.certain = until(certain, ms);
        step.poses = static_cast<int>(poses.size());
        step.share_pct = 100.0 * step.solved / step.poses;
    }
}

}  // namespace

const analysis::Columns<ProfileStep> data_profile_columns = {
    {"comparison", &ProfileStep::comparison, "", "packed_f32 or plain_f64"},
    {"tolerance_pct", &ProfileStep::tolerance_pct, "%", "largest error at the joints of a pose that counts as solved"},
    {"group", &ProfileStep::group, "", "key of a group of deformers"},
    {"ms", &ProfileStep::ms, "ms", "time per frame at which `solved` or `certain` increases"},
    {"solved", &ProfileStep::solved, "", "number of poses that are solved"},
    {"certain", &ProfileStep::certain, "",
     "number of those with an error that is within the tolerance after the bound on the reference's own error is added"},
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

std::optional<double> time_to_solve_certainly(const Diagram& diagram, const DeformerGroup& group, double tolerance_pct)
{
    if (!diagram.reference_error_pct) return std::nullopt;
    return time_to_solve(diagram, group, tolerance_pct - *diagram.reference_error_pct);
}

std::vector<ProfileStep> data_profiles(const std::vector<Diagram>& diagrams)
{
    std::vector<ProfileStep> steps;
    for (const Comparison comparison : comparisons) {
        std::vector<const Diagram*> poses;
        for (const Diagram& diagram : diagrams)
            if (diagram.comparison == comparison && counts(diagram)) poses.push_back(&diagram);
        for (const double tolerance_pct : profile_tolerances_pct)
            for (const DeformerGroup& group : groups_of(diagrams)) add_steps(steps, poses, group, tolerance_pct);
    }
    return steps;
}

Solved solved_within(const std::vector<Diagram>& diagrams, Comparison comparison, const DeformerGroup& group, double tolerance_pct,
                     double ms)
{
    Solved count;
    for (const Diagram& diagram : diagrams) {
        if (diagram.comparison != comparison || !counts(diagram)) continue;
        ++count.poses;
        const std::optional<double> least_ms = time_to_solve(diagram, group, tolerance_pct);
        count.solved += least_ms && *least_ms <= ms;
        const std::optional<double> certain_ms = time_to_solve_certainly(diagram, group, tolerance_pct);
        count.certain += certain_ms && *certain_ms <= ms;
    }
    return count;
}

std::string text_of(const Solved& solved)
{
    if (solved.poses == 0) return "";
    return fmt::format("{} of {}{}", solved.solved, solved.poses, solved.solved ? fmt::format(", {} certain", solved.certain) : "");
}

}  // namespace experiments
