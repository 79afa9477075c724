#include "experiments/deformers/fem/fem_deformers.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace experiments {
namespace {

std::set<int> vertices_of(const pbs::Tets& tets, const std::set<int>& gripped)
{
    std::set<int> vertices;
    for (const int tet : gripped) vertices.insert(tets.row(tet).begin(), tets.row(tet).end());
    return vertices;
}

// Share of the vertices that lie on the skin.
double skin_share(const pbs::Character& character, const std::set<int>& vertices)
{
    if (vertices.empty()) return 0.0;
    const std::vector<bool> skin = pbs::boundary_vertices(character.mesh.tets, character.mesh.rest.rows());
    const auto on_skin = std::count_if(vertices.begin(), vertices.end(), [&](int v) { return skin[v]; });
    return static_cast<double>(on_skin) / static_cast<double>(vertices.size());
}

nlohmann::json to_json(const BoneGrip& grip, const pbs::BoneCapsule& capsule, FemAttachment attachment)
{
    nlohmann::json json = {
        {"bone", grip.name}, {"radius_m", capsule.radius_m}, {"radius_from", capsule.radius_from}, {"skin_share", grip.skin_share}};
    if (attachment == FemAttachment::bind) {
        json.update({{"bound_vertices", grip.holds}, {"bind_error_rms_m", grip.error_rms_m}});
        return json;
    }
    json.update({{"tets_gripped", grip.tets}, {"shared_vertices", grip.shared_vertices}});
    if (grip.holds > 0) json.update({{"samples", grip.holds}, {"inside", grip.inside}, {"grip_error_rms_m", grip.error_rms_m}});
    return json;
}

nlohmann::json to_json(const reference_fem::SetupSummary& setup)
{
    return {{"dofs", setup.dofs},         {"assemble_s", setup.assemble_s}, {"analyse_s", setup.analyse_s},
            {"factor_s", setup.factor_s}, {"elements", setup.elements},     {"solver", setup.solver},
            {"blas", setup.blas},         {"factored", setup.factored},     {"reciprocal_condition_estimate", setup.reciprocal_condition}};
}

}  // namespace

FemRecord::FemRecord(const pbs::Character& character, const FemOptions& options, const BoneAttachment& bones,
                     const std::vector<int>& spring_tet)
    : options_(options), bones_(bones), grips_(bones.capsules.size())
{
    for (std::size_t j = 0; j < grips_.size(); ++j) grips_[j].name = character.skeleton.bones[j].name;
    if (options.attachment == FemAttachment::bind)
        add_bound_vertices(character);
    else
        add_gripped_tets(character, spring_tet);
}

void FemRecord::add_bound_vertices(const pbs::Character& character)
{
    hold_bone_ = bones_.binding.bone;
    hold_rest_ = bones_.binding.rest_point;
    hold_weight_.assign(hold_bone_.size(), 1.0);
    std::vector<std::set<int>> bound(grips_.size());
    for (std::size_t v = 0; v < hold_bone_.size(); ++v) bound[hold_bone_[v]].insert(static_cast<int>(v));
    for (std::size_t j = 0; j < grips_.size(); ++j) {
        grips_[j].holds = grips_[j].inside = static_cast<int>(bound[j].size());
        grips_[j].skin_share = skin_share(character, bound[j]);
    }
}

void FemRecord::add_gripped_tets(const pbs::Character& character, const std::vector<int>& spring_tet)
{
    hold_bone_ = bones_.spring_bone;
    hold_rest_ = bones_.attachment.spring_points;
    hold_weight_ = bones_.spring_density;
    std::vector<std::set<int>> gripped(grips_.size());
    for (std::size_t s = 0; s < spring_tet.size(); ++s) {
        BoneGrip& grip = grips_[hold_bone_[s]];
        ++grip.holds;
        if (spring_tet[s] < 0) continue;
        ++grip.inside;
        if (bones_.spring_density[s] >= gripping_density) gripped[hold_bone_[s]].insert(spring_tet[s]);
    }
    for (std::size_t k = 0; k < bones_.tet_bone.size(); ++k) gripped[bones_.tet_bone[k]].insert(bones_.attachment.prescribed_tets[k]);

    std::vector<int> bones_at_vertex(character.mesh.rest.rows(), 0);
    for (const std::set<int>& tets : gripped)
        for (const int v : vertices_of(character.mesh.tets, tets)) ++bones_at_vertex[v];
    for (std::size_t j = 0; j < grips_.size(); ++j) {
        if (gripped[j].empty())
            throw pbs::InputError(character.name, 0, "bone", grips_[j].name, "expected a part of its middle to lie inside the flesh");
        const std::set<int> vertices = vertices_of(character.mesh.tets, gripped[j]);
        grips_[j].tets = static_cast<int>(gripped[j].size());
        grips_[j].skin_share = skin_share(character, vertices);
        grips_[j].shared_vertices =
            static_cast<int>(std::count_if(vertices.begin(), vertices.end(), [&](int v) { return bones_at_vertex[v] > 1; }));
    }
}

void FemRecord::add_frame(const pbs::Pose& relative_pose)
{
    ++frames_;
    for (const Eigen::Isometry3d& bone : relative_pose)
        largest_rotation_rad_ = std::max(largest_rotation_rad_, Eigen::AngleAxisd(bone.linear()).angle());
}

void FemRecord::add_grip(const pbs::Positions& targets, const Eigen::VectorXd& errors_m)
{
    std::vector<double> squared(grips_.size(), 0.0), weight(grips_.size(), 0.0);
    double error_squared = 0.0, motion_squared = 0.0;
    for (Eigen::Index s = 0; s < targets.rows(); ++s) {
        if (!std::isfinite(errors_m(s))) continue;  // outside the flesh
        if (hold_weight_[s] >= gripping_density) largest_grip_error_m_ = std::max(largest_grip_error_m_, std::abs(errors_m(s)));
        squared[hold_bone_[s]] += hold_weight_[s] * errors_m(s) * errors_m(s);
        weight[hold_bone_[s]] += hold_weight_[s];
        error_squared += hold_weight_[s] * errors_m(s) * errors_m(s);
        motion_squared += hold_weight_[s] * (targets.row(s) - hold_rest_.row(s)).squaredNorm();
    }
    for (std::size_t j = 0; j < grips_.size(); ++j)
        if (weight[j] > 0.0) grips_[j].error_rms_m = std::max(grips_[j].error_rms_m, std::sqrt(squared[j] / weight[j]));
    if (motion_squared > 0.0) grip_error_over_motion_ = std::max(grip_error_over_motion_, std::sqrt(error_squared / motion_squared));
}

nlohmann::json attachment_json(const FemOptions& options)
{
    nlohmann::json attachment = {{"kind", name_of(options.attachment)}};
    if (has_capsules(options.attachment)) attachment["core_radius"] = core_radius_of(options);
    if (has_spring_factor(options.attachment)) attachment["spring_factor"] = spring_factor_of(options);
    if (options.attachment == FemAttachment::smooth) {
        attachment["kernel"] = name_of(options.attachment_kernel);
        attachment["ends"] = options.attachment_ends;
    }
    if (has_sample_points(options.attachment)) attachment["samples"] = options.attachment_samples;
    return attachment;
}

nlohmann::json FemRecord::to_json(const reference_fem::SetupSummary& setup) const
{
    nlohmann::json attachment = attachment_json(options_);
    for (std::size_t j = 0; j < grips_.size(); ++j)
        attachment["bones"].push_back(experiments::to_json(grips_[j], bones_.capsules[j], options_.attachment));
    nlohmann::json json = {
        {"model", name_of(options_.model)},
        {"formulation", name_of(options_.formulation)},
        {"dynamics", name_of(options_.dynamics)},
        {"attachment", attachment},
        {"setup", experiments::to_json(setup)},
        {"frames", frames_},
        {"largest_rotation_deg", largest_rotation_rad_ * 180.0 / std::numbers::pi},
        {"root_motion", options_.dynamics == reference_fem::Dynamics::quasi_static
                            ? "the root's rigid motion is removed before the solve and applied after; gravity is turned into its frame"
                            : "the root moves as the pose has it: the solve is in the world"}};
    if (options_.model == reference_fem::Model::linear)
        json.update(
            {{"fictitious_strain", 1.0 - std::cos(largest_rotation_rad_)},
             {"fictitious_strain_note", "In the linear model a rotation by theta produces a fictitious strain of 1 - cos(theta)."}});
    if (!hold_bone_.empty())
        json.update({{"largest_grip_error_m", largest_grip_error_m_}, {"grip_error_over_motion", grip_error_over_motion_}});
    return json;
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
        halvings_ += stage.halvings();
        for (const reference_fem::LoadStep& step : stage.steps) {
            factorisations_ += step.newton.factorisations;
            projected_ += static_cast<int>(std::ranges::count_if(step.newton.iterations, [](const auto& it) { return it.projected; }));
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
