#include "experiments/deformers/fem/fem_deformers.hpp"
#include "pbs/geometry/topology.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace experiments {
namespace {

nlohmann::json to_json(const reference_fem::SetupSummary& setup)
{
    return {{"dofs", setup.dofs},
            {"assemble_s", setup.assemble_s},
            {"analyse_s", setup.analyse_s},
            {"factor_s", setup.factor_s},
            {"elements", setup.elements},
            {"solver", setup.solver},
            {"blas", setup.blas},
            {"factored", setup.factored},
            {"reciprocal_condition_estimate", setup.reciprocal_condition}};
}

}  // namespace

void FemDeformer::start(const std::vector<int>& spring_tet, const std::vector<bool>& prescribed_vertices)
{
    const pbs::TetMesh& mesh = character_->mesh;
    const bool is_bound = options_.attachment == FemAttachment::bind;
    facts_ = {};
    if (options_.attachment == FemAttachment::nodes) facts_.prescribed = prescribed_vertices;
    facts_.last_state = positions_ = mesh.rest;
    frames_ = 0;
    largest_rotation_rad_ = largest_grip_error_m_ = grip_error_over_motion_ = 0.0;
    hold_bone_ = is_bound ? bones_.binding.bone : bones_.spring_bone;
    hold_rest_ = is_bound ? bones_.binding.rest_point : bones_.attachment.spring_points;
    hold_weight_ = is_bound ? std::vector<double>(hold_bone_.size(), 1.0) : bones_.spring_density;
    const std::size_t bones = bones_.capsules.size();
    grip_error_m_.assign(bones, 0.0);

    std::vector<std::set<int>> tets(bones), vertices(bones);  // that each bone holds
    std::vector<int> holds(bones, 0), inside(bones, 0), bones_at_vertex(mesh.rest.rows(), 0);
    for (std::size_t s = 0; s < hold_bone_.size(); ++s) {
        const int bone = hold_bone_[s];
        ++holds[bone];
        if (is_bound) vertices[bone].insert(static_cast<int>(s));
        if (is_bound || spring_tet[s] < 0) continue;
        ++inside[bone];
        if (hold_weight_[s] >= gripping_density) tets[bone].insert(spring_tet[s]);
    }
    for (std::size_t k = 0; k < bones_.tet_bone.size(); ++k)
        tets[bones_.tet_bone[k]].insert(bones_.attachment.prescribed_tets[k]);
    for (std::size_t j = 0; j < bones; ++j) {
        for (const int tet : tets[j]) vertices[j].insert(mesh.tets.row(tet).begin(), mesh.tets.row(tet).end());
        for (const int v : vertices[j]) ++bones_at_vertex[v];
    }

    const std::vector<bool> skin = pbs::boundary_vertices(mesh.tets, mesh.rest.rows());
    grips_ = nlohmann::json::array();
    for (std::size_t j = 0; j < bones; ++j) {
        const auto on_skin = std::ranges::count_if(vertices[j], [&](int v) { return skin[v]; });
        const double share =
            vertices[j].empty() ? 0.0 : static_cast<double>(on_skin) / static_cast<double>(vertices[j].size());
        const pbs::BoneCapsule& capsule = bones_.capsules[j];
        nlohmann::json& grip = grips_.emplace_back(nlohmann::json{{"bone", character_->skeleton.bones[j].name},
                                                                  {"radius_m", capsule.radius_m},
                                                                  {"radius_from", capsule.radius_from},
                                                                  {"skin_share", share}});
        if (is_bound) {
            grip["bound_vertices"] = holds[j];
            continue;
        }
        grip["tets_gripped"] = tets[j].size();
        grip["shared_vertices"] =  // that another bone grips too, so that P1 cannot follow both
            std::ranges::count_if(vertices[j], [&](int v) { return bones_at_vertex[v] > 1; });
        if (holds[j] > 0) grip.update({{"samples", holds[j]}, {"inside", inside[j]}});
    }
}

void FemDeformer::record_frame(const pbs::Pose& relative_pose)
{
    ++frames_;
    for (const Eigen::Isometry3d& bone : relative_pose)
        largest_rotation_rad_ = std::max(largest_rotation_rad_, Eigen::AngleAxisd(bone.linear()).angle());
}

void FemDeformer::record_grip(const pbs::Positions& targets, const Eigen::VectorXd& errors_m)
{
    std::vector<double> squared(grip_error_m_.size(), 0.0), weight(grip_error_m_.size(), 0.0);
    double error_squared = 0.0, motion_squared = 0.0;
    for (Eigen::Index s = 0; s < targets.rows(); ++s) {
        if (!std::isfinite(errors_m(s))) continue;  // outside the flesh
        if (hold_weight_[s] >= gripping_density)
            largest_grip_error_m_ = std::max(largest_grip_error_m_, std::abs(errors_m(s)));
        squared[hold_bone_[s]] += hold_weight_[s] * errors_m(s) * errors_m(s);
        weight[hold_bone_[s]] += hold_weight_[s];
        error_squared += hold_weight_[s] * errors_m(s) * errors_m(s);
        motion_squared += hold_weight_[s] * (targets.row(s) - hold_rest_.row(s)).squaredNorm();
    }
    for (std::size_t j = 0; j < weight.size(); ++j)
        if (weight[j] > 0.0) grip_error_m_[j] = std::max(grip_error_m_[j], std::sqrt(squared[j] / weight[j]));
    if (motion_squared > 0.0)
        grip_error_over_motion_ = std::max(grip_error_over_motion_, std::sqrt(error_squared / motion_squared));
}

nlohmann::json attachment_json(const FemOptions& options)
{
    nlohmann::json attachment = {{"kind", name_of(options.attachment)}};
    if (options.has_capsules()) attachment["core_radius"] = options.used_core_radius();
    if (options.has_spring_factor()) attachment["spring_factor"] = options.used_spring_factor();
    if (options.is_smooth())
        attachment.update({{"kernel", name_of(options.attachment_kernel)}, {"ends", options.attachment_ends}});
    if (options.has_sample_points()) attachment["samples"] = options.attachment_samples;
    return attachment;
}

nlohmann::json FemDeformer::recorded(const reference_fem::SetupSummary& setup) const
{
    nlohmann::json attachment = attachment_json(options_);
    attachment["bones"] = grips_;
    if (bones_.loose_parts > 0)
        attachment.update({{"loose_parts", bones_.loose_parts}, {"loose_pct", 100.0 * bones_.loose_share}});
    for (std::size_t j = 0; j < grips_.size(); ++j) {
        if (grips_[j].contains("samples")) attachment["bones"][j]["grip_error_rms_m"] = grip_error_m_[j];
        if (grips_[j].contains("bound_vertices")) attachment["bones"][j]["bind_error_rms_m"] = grip_error_m_[j];
    }
    nlohmann::json json = {
        {"model", name_of(options_.model)},
        {"formulation", name_of(options_.formulation)},
        {"dynamics", name_of(options_.dynamics)},
        {"attachment", attachment},
        {"setup", to_json(setup)},
        {"frames", frames_},
        {"largest_rotation_deg", largest_rotation_rad_ * 180.0 / std::numbers::pi},
        {"root_motion",
         options_.dynamics == reference_fem::Dynamics::quasi_static
             ? "the root's rigid motion is removed before the solve and applied after; gravity is turned into its frame"
             : "the root moves as the pose has it: the solve is in the world"}};
    if (options_.model == reference_fem::Model::linear)
        json.update({{"fictitious_strain", 1.0 - std::cos(largest_rotation_rad_)},
                     {"fictitious_strain_note",
                      "In the linear model a rotation by theta produces a fictitious strain of 1 - cos(theta)."}});
    if (!hold_bone_.empty())
        json.update(
            {{"largest_grip_error_m", largest_grip_error_m_}, {"grip_error_over_motion", grip_error_over_motion_}});
    return json;
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
        halvings_ += stage.halvings();
        for (const reference_fem::LoadStep& step : stage.steps) {
            factorisations_ += step.newton.factorisations;
            projected_ += static_cast<int>(
                std::ranges::count_if(step.newton.iterations, [](const auto& it) { return it.projected; }));
        }
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
        const reference_fem::NewtonSummary& last = solve.stages.back().steps.back().newton;
        not_converged_.push_back({{"frame", frames_},
                                  {"reached", solve.reached},
                                  {"restarted_from_rest", solve.restarted},
                                  {"worst_tet", flesh.lowest_tet},
                                  {"lowest_det_f", flesh.lowest},
                                  {"inverted_points", flesh.inverted},
                                  {"newton", reference_fem::name_of(last.outcome)},
                                  {"last_residual_n", last.iterations.back().residual_n},
                                  {"force_scale_n", last.iterations.back().force_scale_n}});
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
            {"volume_change_pct",
             {{"lowest", 100.0 * smallest_volume_change_}, {"highest", 100.0 * largest_volume_change_}}},
            {"solve_s", {{"mean", seconds_ / frames}, {"longest", longest_s_}}}};
}

}  // namespace experiments
