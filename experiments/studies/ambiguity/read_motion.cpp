#include "experiments/studies/ambiguity/read_motion.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/scene/scene.hpp"

namespace experiments {
namespace {

std::vector<bool> zone_of(const pbs::Character& character, const Reading& reading)
{
    if (!reading.options.jiggle) return {};
    return reading.zone_mean == ZoneMean::of_bone ? pbs::jiggle_zone_by_bone(character.binding) : pbs::jiggle_zone(character.binding);
}

pbs::Motion motion_of(const pbs::Character& character, const Scene& scene, int substeps)
{
    MotionSpec spec = scene.motion;
    if (!spec.clip.empty()) spec.time_step_s /= substeps;
    return make_motion(spec, character.skeleton, scene.file);
}

analysis::CaseRecord record_of(const Scene& scene, const std::string& deformer)
{
    analysis::CaseRecord record;
    record.scene = scene.name;
    record.deformer = deformer;
    return record;
}

void add_frame(analysis::CaseRecord& record, int frame, double time_s, const pbs::Motion& motion, const analysis::FrameMetrics& metrics)
{
    record.frame.push_back(frame);
    record.time_s.push_back(time_s);
    if (!motion.angle_deg.empty()) record.angle_deg.push_back(motion.angle_deg[frame]);
    record.volume_change_pct.push_back(metrics.volume_change_pct);
    record.volume_abs_change_pct.push_back(metrics.volume_abs_change_pct);
    record.inverted_tets.push_back(metrics.inverted_tets);
}

}  // namespace

pbs::Weights weights_of(const pbs::Character& character, const Reading& reading)
{
    return reading.blended_bones == BlendedBones::either_end ? pbs::either_end_weights(character.binding, character.skeleton)
                                                             : character.weights;
}

pbs::Positions bind_points_of(const pbs::Character& character, const Reading& reading, const pbs::Pose& pose, const pbs::Positions& lbs)
{
    return reading.bind_point == BindPoint::reprojected ? pbs::reprojected_bind_points(character.binding, character.skeleton, pose, lbs)
                                                        : pbs::posed_bind_points(character.binding, pose);
}

void ReadDeformer::reset(const pbs::Character& character)
{
    character_ = &character;
    skinning_.emplace(character.mesh.rest, weights_of(character, reading_));
    solver_ = std::make_unique<pbs::PbsSolver>(character.mesh, character.binding.distance, zone_of(character, reading_), reading_.options);
}

pbs::StepSummary ReadDeformer::advance(const pbs::Pose& pose, double dt_s)
{
    skinning_->linear(pose, lbs_);
    return solver_->advance(lbs_, bind_points_of(*character_, reading_, pose, lbs_), dt_s);
}

ReadMotion move(const pbs::Character& character, const Scene& scene, const Reading& reading)
{
    const pbs::Motion motion = motion_of(character, scene, reading.substeps);
    const analysis::MeshMetrics mesh_metrics(character.mesh.rest, character.mesh.tets);
    ReadDeformer moving(reading);
    moving.reset(character);
    ReadMotion moved;
    moved.pbs = record_of(scene, "pbs");
    moved.pbs.iterations = reading.options.iterations;
    moved.lbs = record_of(scene, "lbs");
    for (int step = 0; step < static_cast<int>(motion.steps.size()); ++step) {
        const bool is_frame = step % motion.steps_per_frame == 0;
        if (!is_frame && !moving.has_memory()) continue;
        stop_if_interrupted();
        moving.advance(motion.steps[step], motion.time_step_s);
        if (!is_frame) continue;
        const int frame = step / motion.steps_per_frame;
        add_frame(moved.pbs, frame, step * motion.time_step_s, motion, mesh_metrics.measure(moving.positions()));
        add_frame(moved.lbs, frame, step * motion.time_step_s, motion, mesh_metrics.measure(moving.lbs()));
        moved.shapes.push_back(moving.positions());
        moved.finite = moved.finite && moving.positions().allFinite();
    }
    return moved;
}

}  // namespace experiments
