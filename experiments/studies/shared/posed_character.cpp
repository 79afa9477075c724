#include "experiments/studies/shared/posed_character.hpp"

#include "experiments/run/broken_frames.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <algorithm>
#include <limits>

namespace experiments {

pbs::Positions blended(const pbs::Character& character, const pbs::Pose& pose)
{
    pbs::Positions positions;
    pbs::linear_blend_skinning(character.mesh.rest, character.weights, pose, positions);
    return positions;
}

pbs::Positions carried_by_lbs(const pbs::Positions& shape, const pbs::Character& character, const pbs::Pose& from,
                              const pbs::Pose& to)
{
    pbs::Pose moved = to;
    for (std::size_t b = 0; b < moved.size(); ++b) moved[b] = moved[b] * from[b].inverse();
    pbs::Positions carried;
    pbs::linear_blend_skinning(shape, character.weights, moved, carried);
    return carried;
}

std::vector<pbs::Positions> shapes_in_motion(const pbs::Character& character, const pbs::Motion& motion,
                                             const DeformerSpec& spec)
{
    const std::unique_ptr<Deformer> deformer = make_deformer(spec);
    deformer->reset(character);
    std::vector<pbs::Positions> shapes;
    for (int step = 0; step < static_cast<int>(motion.steps.size()); ++step) {
        const bool is_frame = step % motion.steps_per_frame == 0;
        if (!is_frame && !deformer->has_memory()) continue;
        deformer->advance(motion.steps[step], motion.time_step_s);
        if (is_frame) shapes.push_back(deformer->positions());
    }
    return shapes;
}

PosedCharacter::PosedCharacter(const Scene& scene, const std::vector<int>& frames)
    : character_(pbs::make_character(scene.character)),
      time_step_s_(scene.motion.time_step_s),
      error_metrics_(error_domain(character_, {})),
      boundary_(pbs::boundary_of(character_.mesh.tets))
{
    const pbs::Motion motion = make_motion(scene.motion, character_.skeleton, scene.file);
    for (const int frame : frames) {
        poses_.push_back(motion.steps.at(static_cast<std::size_t>(frame) * motion.steps_per_frame));
        angles_deg_.push_back(motion.angle_deg.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                       : motion.angle_deg[frame]);
    }
}

Shape PosedCharacter::shape_of(const pbs::StepSummary& step, const pbs::Positions& positions,
                               const pbs::Positions& last_state) const
{
    Shape shape{positions, step.outcome == pbs::Outcome::finished, step.seconds};
    if (shape.finished) return shape;
    const pbs::TetMesh& mesh = character_.mesh;
    const Eigen::VectorXd ratios =
        pbs::tet_volumes(last_state, mesh.tets).cwiseQuotient(pbs::tet_volumes(mesh.rest, mesh.tets));
    shape.worst_element = worst_element(broken_frame(0, step.outcome, last_state, ratios));
    return shape;
}

Shapes PosedCharacter::shapes(const DeformerSpec& spec, std::optional<std::size_t> poses) const
{
    const std::unique_ptr<Deformer> deformer = make_deformer(spec);
    Shapes shapes;
    const std::size_t count = std::min(poses.value_or(poses_.size()), poses_.size());
    for (std::size_t pose = 0; pose < count; ++pose) {
        if (pose == 0 || deformer->has_memory()) deformer->reset(character_);
        const pbs::StepSummary step = deformer->advance(poses_[pose], time_step_s_);
        shapes.push_back(shape_of(step, deformer->positions(), last_state(*deformer)));
    }
    return shapes;
}

std::vector<Shapes> PosedCharacter::shapes(const std::vector<pbs::PbsOptions>& options) const
{
    std::vector<pbs::PbsOptions> of_lane;
    std::vector<pbs::Positions> lbs, bind_points;
    for (const pbs::PbsOptions& own : options)
        for (const pbs::Pose& pose : poses_) {
            of_lane.push_back(own);
            lbs.push_back(blended(character_, pose));
            bind_points.push_back(pbs::posed_bind_points(character_.binding, pose));
        }
    pbs::PosesSolver solver(character_.mesh, character_.binding.distance, {}, of_lane);
    const std::vector<pbs::StepSummary> steps = solver.advance(lbs, bind_points, time_step_s_);
    std::vector<Shapes> all(options.size());
    for (std::size_t lane = 0; lane < steps.size(); ++lane) {
        const pbs::Positions& positions = solver.positions(static_cast<int>(lane));
        all[lane / poses_.size()].push_back(shape_of(steps[lane], positions, positions));
    }
    return all;
}

analysis::ErrorNorms PosedCharacter::distance(const Shape& shape, const Shape& other) const
{
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    if (!shape.finished || !other.finished) return {nothing, nothing, nothing};
    const Eigen::Index vertices = character_.mesh.rest.rows();
    return error_metrics_.measure(shape.positions.topRows(vertices), other.positions.topRows(vertices));
}

const DeformerSpec& spec_of(const Scene& scene, const std::string& name)
{
    const auto found = std::find_if(scene.deformers.begin(), scene.deformers.end(),
                                    [&](const auto& spec) { return spec.name == name; });
    if (found == scene.deformers.end())
        throw pbs::InputError(scene.file, 0, "deformers.use", name, "expected this deformer in the scene");
    return *found;
}

const analysis::Columns<analysis::CaseKey>& pose_columns()
{
    static const analysis::Columns<analysis::CaseKey> columns =
        MEMBER_COLUMNS(analysis::CaseKey, body, motion, pose, angle_deg);
    return columns;
}

}  // namespace experiments
