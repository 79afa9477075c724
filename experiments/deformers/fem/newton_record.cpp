#include "experiments/deformers/fem/newton_record.hpp"

#include <algorithm>

namespace experiments {

void NewtonRecord::add_stage(const reference_fem::LoadPathSummary& stage)
{
    halvings_ += stage.halvings();
    for (const reference_fem::LoadStep& step : stage.steps) {
        factorisations_ += step.newton.factorisations;
        projected_ += static_cast<int>(
            std::count_if(step.newton.iterations.begin(), step.newton.iterations.end(), [](const auto& it) { return it.projected; }));
    }
}

void NewtonRecord::add_failure(const FrameSolve& solve, const reference_fem::Jacobians& flesh)
{
    nlohmann::json failure = {{"frame", frames_},
                              {"reached", solve.reached},
                              {"restarted_from_rest", solve.restarted},
                              {"worst_tet", flesh.lowest_tet},
                              {"lowest_det_f", flesh.lowest},
                              {"inverted_points", flesh.inverted}};
    const reference_fem::NewtonSummary& last = solve.stages.back().steps.back().newton;
    failure["newton"] = reference_fem::name_of(last.outcome);
    failure["last_residual_n"] = last.iterations.back().residual_n;
    failure["force_scale_n"] = last.iterations.back().force_scale_n;
    not_converged_.push_back(failure);
}

void NewtonRecord::add_frame_without_start(const nlohmann::json& failure_with_fewer_nodes)
{
    not_converged_.push_back({{"frame", frames_},
                              {"reached", 0.0},
                              {"newton", "the solution with fewer nodes was not reached"},
                              {"fewer_nodes", failure_with_fewer_nodes}});
    ++frames_;
}

void NewtonRecord::add_frame(const FrameSolve& solve, const reference_fem::Jacobians& flesh)
{
    int newton_steps = 0;
    double seconds = 0.0;
    for (const auto& stage : solve.stages) {
        add_stage(stage);
        newton_steps += stage.newton_steps();
        seconds += stage.seconds;
    }
    newton_steps_ += newton_steps;
    most_newton_steps_ = std::max(most_newton_steps_, newton_steps);
    seconds_ += seconds;
    longest_s_ = std::max(longest_s_, seconds);
    restarts_ += solve.restarted;
    if (solve.converged()) {
        const double volume_change = flesh.volume / rest_volume_m3_ - 1.0;
        smallest_volume_change_ = std::min(smallest_volume_change_, volume_change);
        largest_volume_change_ = std::max(largest_volume_change_, volume_change);
        lowest_det_f_ = std::min(lowest_det_f_, flesh.lowest);
        most_inverted_points_ = std::max(most_inverted_points_, flesh.inverted);
    } else {
        add_failure(solve, flesh);
    }
    ++frames_;
}

nlohmann::json NewtonRecord::to_json() const
{
    const double frames = std::max(frames_, 1);
    return {{"newton_steps", {{"mean", newton_steps_ / frames}, {"most", most_newton_steps_}}},
            {"factorisations", factorisations_},
            {"projected_hessians", projected_},
            {"halvings", halvings_},
            {"restarts_from_rest", restarts_},
            {"frames_not_converged", not_converged_.size()},
            {"not_converged", not_converged_},
            {"lowest_det_f", lowest_det_f_},
            {"most_inverted_points", most_inverted_points_},
            {"volume_change_pct", {{"lowest", 100.0 * smallest_volume_change_}, {"highest", 100.0 * largest_volume_change_}}},
            {"solve_s", {{"mean", seconds_ / frames}, {"longest", longest_s_}}}};
}

}  // namespace experiments
