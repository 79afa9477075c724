#include "experiments/studies/ambiguity/readings.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace experiments {

const analysis::Columns<VolumeChange> volume_change_columns =
    MEMBER_COLUMNS(VolumeChange, scene, place, reading_a, reading_b, quantity, a, b, change);

namespace {

// The frames of the motion as a record of one deformer.
analysis::CaseRecord record_of(const Scene& scene, const pbs::Motion& motion, const analysis::MeshMetrics& mesh_metrics,
                               const std::vector<pbs::Positions>& shapes)
{
    analysis::CaseRecord record{.scene = scene.name, .place = {.body = scene.name}, .angle_deg = motion.angle_deg};
    for (std::size_t frame = 0; frame < shapes.size(); ++frame) {
        const analysis::FrameMetrics metrics = mesh_metrics.measure(shapes[frame]);
        record.frame.push_back(double(frame));
        record.time_s.push_back(double(frame) * motion.steps_per_frame * motion.time_step_s);
        record.volume_change_pct.push_back(metrics.volume_change_pct);
        record.volume_abs_change_pct.push_back(metrics.volume_abs_change_pct);
        record.inverted_tets.push_back(metrics.inverted_tets);
    }
    return record;
}

// Root mean square over frames and vertices of the zone, or all where it is empty [m].
double distance_m(const ReadMotion& a, const ReadMotion& b, const std::vector<bool>& zone)
{
    double sum = 0.0;
    long long count = 0;
    for (std::size_t frame = 0; frame < std::min(a.shapes.size(), b.shapes.size()); ++frame)
        for (Eigen::Index i = 0; i < a.shapes[frame].rows(); ++i) {
            if (!zone.empty() && !zone[i]) continue;
            sum += (a.shapes[frame].row(i) - b.shapes[frame].row(i)).squaredNorm();
            ++count;
        }
    return std::sqrt(sum / double(count));
}

// One reading's way through the motion, one frame per turn, in the order and precision that are judged.
class TimedReading {
public:
    TimedReading(const StudyCase& study_case, const pbs::Character& base, const pbs::Motion& motion,
                 const Overrides& reading)
        : motion_(motion), dt_s_(motion.time_step_s)
    {
        const Scene scene = study_case.scene(reading);
        DeformerSpec spec = spec_of(scene, "pbs");
        options_of<pbs::PbsOptions>(spec).order = pbs::Order::plain;
        options_of<pbs::PbsOptions>(spec).precision = pbs::Precision::f64;
        substeps_ = static_cast<int>(std::lround(dt_s_ / scene.motion.time_step_s));
        character_ = reweighted(base, scene);
        deformer_ = make_deformer(spec);
        deformer_->reset(character_);
    }

    std::vector<double> turn()
    {
        const pbs::Pose& pose = motion_.steps[next_];
        next_ = (next_ + static_cast<std::size_t>(motion_.steps_per_frame)) % motion_.steps.size();
        const double took_s = cpu_seconds([&] {
            for (int substep = 0; substep < substeps_; ++substep) deformer_->advance(pose, dt_s_ / substeps_);
        });
        finite_ = finite_ && deformer_->positions().allFinite();
        return {took_s};
    }

    bool finite() const { return finite_; }  // in every turn

private:
    const pbs::Motion& motion_;
    int substeps_ = 1;
    double dt_s_;
    pbs::Character character_;
    std::unique_ptr<Deformer> deformer_;
    std::size_t next_ = 0;
    bool finite_ = true;
};

}  // namespace

ReadMotion move(const pbs::Character& character, const Scene& scene)
{
    const pbs::Motion motion = make_motion(scene.motion, character.skeleton, scene.file);
    const analysis::MeshMetrics mesh_metrics(character.mesh.rest, character.mesh.tets);
    const DeformerSpec& pbs = spec_of(scene, "pbs");
    ReadMotion moved;
    moved.shapes = shapes_in_motion(character, motion, pbs);
    moved.pbs = record_of(scene, motion, mesh_metrics, moved.shapes);
    moved.pbs.deformer = "pbs";
    moved.pbs.iterations = *traits_of(pbs).iterations;
    moved.lbs = record_of(scene, motion, mesh_metrics, shapes_in_motion(character, motion, default_spec("lbs")));
    moved.lbs.deformer = "lbs";
    moved.finite = std::ranges::all_of(moved.shapes, [](const pbs::Positions& shape) { return shape.allFinite(); });
    return moved;
}

std::vector<VolumeChange> volume_changes(const std::string& scene, const Reading& reading, const ReadMotion& a,
                                         const ReadMotion& b, const ReadMotion& resting, const std::vector<bool>& zone)
{
    using analysis::mean;
    std::vector<VolumeChange> rows;
    const auto add = [&](const std::string& quantity, double of_a, double of_b) {
        rows.push_back({scene, reading.place, reading.baseline, reading.name, quantity, of_a, of_b, of_b - of_a});
    };
    add("mean_volume_change_pct", mean(a.pbs.volume_change_pct), mean(b.pbs.volume_change_pct));
    add("mean_volume_abs_change_pct", mean(a.pbs.volume_abs_change_pct), mean(b.pbs.volume_abs_change_pct));
    add("mean_volume_change_of_lbs_pct", mean(a.lbs.volume_change_pct), mean(b.lbs.volume_change_pct));
    add("share_of_frames_within_printed", analysis::share_of_kept_frames(a.pbs.volume_change_pct),
        analysis::share_of_kept_frames(b.pbs.volume_change_pct));
    add("mean_inverted_tets", mean(a.pbs.inverted_tets), mean(b.pbs.inverted_tets));
    for (std::size_t frame = 0; frame < a.pbs.angle_deg.size(); ++frame) {
        const double angle = a.pbs.angle_deg[frame];
        if (std::abs(angle - 90.0) >= 1e-6 && std::abs(angle - 170.0) >= 1e-6) continue;
        add(fmt::format("volume_change_at_{:.0f}_deg_pct", angle), a.pbs.volume_change_pct[frame],
            b.pbs.volume_change_pct[frame]);
        add(fmt::format("volume_abs_change_at_{:.0f}_deg_pct", angle), a.pbs.volume_abs_change_pct[frame],
            b.pbs.volume_abs_change_pct[frame]);
    }
    add("distance_of_b_from_a_rms_m", 0.0, distance_m(a, b, {}));
    add("distance_of_zone_by_jiggle_rms_m", distance_m(a, resting, zone), distance_m(b, resting, zone));
    return rows;
}

std::vector<JudgedReading> values_of_frames(const StudyCase& study_case, const std::vector<Overrides>& readings)
{
    const Scene scene = study_case.scene();
    const pbs::Character character = pbs::make_character(scene.character);
    const pbs::Motion motion = make_motion(scene.motion, character.skeleton, scene.file);
    std::vector<std::unique_ptr<TimedReading>> timed;
    std::vector<TimedVariant> turns;
    for (const Overrides& reading : readings) {
        timed.push_back(std::make_unique<TimedReading>(study_case, character, motion, reading));
        turns.push_back([turning = timed.back().get()] { return turning->turn(); });
    }
    const auto seconds = take_turns(turns, {.seconds = study_case.value<double>("timing_s")});
    std::vector<JudgedReading> judged_readings;
    for (std::size_t i = 0; i < timed.size(); ++i) {
        const double per_s = 1.0 / spread_of(seconds[i][0]).median;
        const analysis::CaseKey of_frame = {.body = scene.character.body, .deformer = "pbs"};
        judged_readings.push_back(
            {judged({{"C10", "frames_per_s", of_frame, per_s, per_s, per_s, "1/s"}}), !timed[i]->finite()});
    }
    return judged_readings;
}

}  // namespace experiments
