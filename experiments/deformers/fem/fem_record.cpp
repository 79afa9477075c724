#include "experiments/deformers/fem/fem_record.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

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

nlohmann::json to_json(const BoneGrip& grip, const BoneCapsule& capsule, FemAttachment attachment)
{
    nlohmann::json json = {{"bone", grip.name},         {"radius_m", capsule.radius_m},  {"radius_from", capsule.radius_from},
                           {"tets_gripped", grip.tets}, {"skin_share", grip.skin_share}, {"shared_vertices", grip.shared_vertices}};
    if (attachment == FemAttachment::embedded)
        json.update({{"samples", grip.samples}, {"inside", grip.inside}, {"grip_error_rms_m", grip.error_rms_m}});
    return json;
}

nlohmann::json to_json(const reference_fem::SetupSummary& setup)
{
    return {{"dofs", setup.dofs},           {"assemble_s", setup.assemble_s},
            {"analyse_s", setup.analyse_s}, {"factor_s", setup.factor_s},
            {"elements", setup.elements},
            {"solver", setup.solver},       {"blas", setup.blas},
            {"factored", setup.factored},   {"reciprocal_condition_estimate", setup.reciprocal_condition}};
}

}  // namespace

FemRecord::FemRecord(const pbs::Character& character, const FemOptions& options, const BoneAttachment& bones,
                     const std::vector<int>& spring_tet)
    : options_(options), bones_(bones), grips_(bones.capsules.size())
{
    std::vector<std::set<int>> gripped(grips_.size());
    for (std::size_t s = 0; s < spring_tet.size(); ++s) {
        BoneGrip& grip = grips_[bones.spring_bone[s]];
        ++grip.samples;
        if (spring_tet[s] < 0) continue;
        ++grip.inside;
        gripped[bones.spring_bone[s]].insert(spring_tet[s]);
    }
    for (std::size_t k = 0; k < bones.tet_bone.size(); ++k) gripped[bones.tet_bone[k]].insert(bones.attachment.prescribed_tets[k]);

    std::vector<int> bones_at_vertex(character.mesh.rest.rows(), 0);
    for (const std::set<int>& tets : gripped)
        for (const int v : vertices_of(character.mesh.tets, tets)) ++bones_at_vertex[v];
    const std::vector<bool> skin = pbs::boundary_vertices(character.mesh.tets, character.mesh.rest.rows());
    for (std::size_t j = 0; j < grips_.size(); ++j) {
        grips_[j].name = character.skeleton.bones[j].name;
        if (gripped[j].empty())
            throw pbs::InputError(character.name, 0, "bone", grips_[j].name, "expected a part of its middle to lie inside the flesh");
        const std::set<int> vertices = vertices_of(character.mesh.tets, gripped[j]);
        const auto on_skin = std::count_if(vertices.begin(), vertices.end(), [&](int v) { return skin[v]; });
        grips_[j].tets = static_cast<int>(gripped[j].size());
        grips_[j].skin_share = static_cast<double>(on_skin) / static_cast<double>(vertices.size());
        grips_[j].shared_vertices =
            static_cast<int>(std::count_if(vertices.begin(), vertices.end(), [&](int v) { return bones_at_vertex[v] > 1; }));
    }
}

void FemRecord::add_frame(const pbs::Pose& relative_pose, const pbs::Positions& targets, const pbs::Positions& deformed,
                          const reference_fem::SolveSummary& solve)
{
    ++frames_;
    if (!solve.finite) ++frames_not_finite_;
    largest_residual_ = std::max(largest_residual_, solve.residual);
    for (const Eigen::Isometry3d& bone : relative_pose)
        largest_rotation_rad_ = std::max(largest_rotation_rad_, Eigen::AngleAxisd(bone.linear()).angle());
    if (solve.finite) add_grip_errors(targets, deformed);
}

void FemRecord::add_grip_errors(const pbs::Positions& targets, const pbs::Positions& deformed)
{
    std::vector<double> squared(grips_.size(), 0.0);
    double error_squared = 0.0, motion_squared = 0.0;
    for (Eigen::Index s = 0; s < targets.rows(); ++s) {
        if (!deformed.row(s).allFinite()) continue;  // outside the flesh
        const double error = (targets.row(s) - deformed.row(s)).norm();
        largest_grip_error_m_ = std::max(largest_grip_error_m_, error);
        squared[bones_.spring_bone[s]] += error * error;
        error_squared += error * error;
        motion_squared += (targets.row(s) - bones_.attachment.spring_points.row(s)).squaredNorm();
    }
    for (std::size_t j = 0; j < grips_.size() && targets.rows() > 0; ++j)
        grips_[j].error_rms_m = std::max(grips_[j].error_rms_m, std::sqrt(squared[j] / grips_[j].inside));
    if (motion_squared > 0.0) grip_error_over_motion_ = std::max(grip_error_over_motion_, std::sqrt(error_squared / motion_squared));
}

nlohmann::json FemRecord::to_json(const reference_fem::SetupSummary& setup) const
{
    const bool embedded = options_.attachment == FemAttachment::embedded;
    nlohmann::json attachment = {{"kind", embedded ? "embedded" : "nodes"}, {"core_radius", options_.core_radius}};
    if (embedded) attachment["spring_factor"] = options_.spring_factor;
    for (std::size_t j = 0; j < grips_.size(); ++j)
        attachment["bones"].push_back(experiments::to_json(grips_[j], bones_.capsules[j], options_.attachment));

    nlohmann::json json = {
        {"attachment", attachment},
        {"setup", experiments::to_json(setup)},
        {"frames", frames_},
        {"frames_not_finite", frames_not_finite_},
        {"largest_rotation_deg", largest_rotation_rad_ * 180.0 / std::numbers::pi},
        {"fictitious_strain", 1.0 - std::cos(largest_rotation_rad_)},
        {"fictitious_strain_note", "linear strain takes a rotation by theta for a strain of 1 - cos(theta): fictitious by that much"},
        {"root_motion", "the root's rigid motion is removed before the solve and applied after; gravity is turned into its frame"},
        {"largest_residual", largest_residual_}};
    if (embedded) json.update({{"largest_grip_error_m", largest_grip_error_m_}, {"grip_error_over_motion", grip_error_over_motion_}});
    return json;
}

}  // namespace experiments
