#include "experiments/ambiguity/read_motion.hpp"

#include "analysis/frame_metrics.hpp"
#include "experiments/cases/motion_case.hpp"
#include "experiments/interruption.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

namespace experiments {
namespace {

pbs::Motion motion_of(const pbs::Character& character, const Scene& scene, int substeps)
{
    MotionSpec spec = scene.motion;
    if (!spec.clip.empty()) spec.time_step_s /= substeps;
    return make_motion(spec, character.skeleton, scene.file);
}

std::vector<bool> zone_of(const pbs::Character& character, const Reading& reading)
{
    if (!reading.options.jiggle) return {};
    return reading.zone_mean == ZoneMean::of_bone ? pbs::jiggle_zone_by_bone(character.binding) : pbs::jiggle_zone(character.binding);
}

class ReadCharacter {
public:
    ReadCharacter(const pbs::Character& character, const Reading& reading)
        : character_(character),
          reading_(reading),
          weights_(reading.blended_bones == BlendedBones::either_end ? pbs::either_end_weights(character.binding, character.skeleton)
                                                                     : character.weights),
          solver_(character.mesh, character.binding.distance, zone_of(character, reading), reading.options)
    {
    }

    void advance(const pbs::Pose& pose, double dt_s)
    {
        pbs::linear_blend_skinning(character_.mesh.rest, weights_, pose, lbs);
        const pbs::Positions bind_points = reading_.bind_point == BindPoint::reprojected
                                               ? pbs::reprojected_bind_points(character_.binding, character_.skeleton, pose, lbs)
                                               : pbs::posed_bind_points(character_.binding, pose);
        solver_.advance(lbs, bind_points, dt_s);
    }

    const pbs::Positions& positions() const { return solver_.positions(); }
    bool remembers() const { return reading_.options.jiggle || reading_.options.lbs_entry == pbs::LbsEntry::increment; }

    pbs::Positions lbs;  // of the last step [m], #V x 3

private:
    const pbs::Character& character_;
    const Reading& reading_;
    pbs::Weights weights_;
    pbs::PbsSolver solver_;
};

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

ReadMotion move(const pbs::Character& character, const Scene& scene, const Reading& reading)
{
    const pbs::Motion motion = motion_of(character, scene, reading.substeps);
    const analysis::Ruler ruler(character.mesh.rest, character.mesh.tets);
    ReadCharacter moving(character, reading);
    ReadMotion moved;
    moved.pbs = record_of(scene, "pbs");
    moved.pbs.iterations = reading.options.iterations;
    moved.lbs = record_of(scene, "lbs");
    for (int step = 0; step < static_cast<int>(motion.steps.size()); ++step) {
        const bool is_frame = step % motion.steps_per_frame == 0;
        if (!is_frame && !moving.remembers()) continue;
        stop_if_interrupted();
        moving.advance(motion.steps[step], motion.time_step_s);
        if (!is_frame) continue;
        const int frame = step / motion.steps_per_frame;
        add_frame(moved.pbs, frame, step * motion.time_step_s, motion, ruler.measure(moving.positions()));
        add_frame(moved.lbs, frame, step * motion.time_step_s, motion, ruler.measure(moving.lbs));
        moved.shapes.push_back(moving.positions());
        moved.finite = moved.finite && moving.positions().allFinite();
    }
    return moved;
}

}  // namespace experiments
