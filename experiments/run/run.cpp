#include "experiments/run/run.hpp"

#include "experiments/characters/bodies.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/broken_frames.hpp"
#include "experiments/run/compared_reference.hpp"
#include "experiments/run/doubtful_results.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/run/run_remarks.hpp"
#include "experiments/run/runners.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/system/child_process.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <optional>

namespace experiments {

analysis::Provenance run_provenance(int threads)
{
    analysis::Provenance provenance = analysis::collect_provenance(threads);
    provenance.libraries["CGAL"] = PBS_CGAL_VERSION;
    provenance.libraries["VTK"] = PBS_VTK_VERSION;
    provenance.libraries["assimp"] = PBS_ASSIMP_VERSION;
    provenance.blas = blas_in_use();
    return provenance;
}

nlohmann::json run_end(double wall_s)
{
    return {{"ended_utc", fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)))}, {"wall_s", wall_s}};
}

namespace {

// Without a reference no errors can be measured.
OutputSpec measured_output(const Scene& scene)
{
    OutputSpec output = scene.output;
    output.errors = output.errors && !scene.reference.empty();
    return output;
}

// The rendered surface is needed if it is measured or written.
pbs::Character character_with_remarks(const Scene& scene, RunRemarks& remarks)
{
    pbs::CharacterSource source = scene.character;
    source.surface = scene.output.surface || scene.output.frames_every > 0 || !scene.output.frames.empty();
    pbs::RemarkList character_remarks;
    pbs::Character character = pbs::make_character(source, character_remarks);
    remarks.add(character_remarks);
    return character;
}

// Reads the motion, and adds the hashes of its clip to the character's inputs; a sweep has no clip.
CaseMotion read_motion(const Scene& scene, pbs::Character& character, RunRemarks& remarks)
{
    const pbs::InputFile clip(scene.motion.clip);
    CaseMotion motion = make_case_motion(scene.motion, character, scene.file);
    take_bones_that_move_as_one(motion.motion, character);
    remarks.add(motion.remarks);
    remarks.add(pbs::Gravity::information, motion.notes);
    for (const int frame : scene.output.frames)
        if (frame >= motion.motion.frames())
            throw pbs::InputError(scene.file, 0, "output.frames", std::to_string(frame),
                                  fmt::format("expected less than the motion's {} frames", motion.motion.frames()));
    if (scene.motion.clip.empty()) return motion;
    for (const auto& hashed : clip.hashed()) character.inputs.push_back(hashed);
    return motion;
}

nlohmann::json motion_record(const CaseMotion& motion)
{
    nlohmann::json record = {{"largest_rotation_deg", motion.largest_rotation_deg},
                             {"time_zero", motion.time_zero},
                             {"time_zero_s", motion.time_zero_s}};
    if (motion.clip_joints > 0)
        record.update({{"clip_joints", motion.clip_joints}, {"matched_joints", motion.matched_joints}});
    if (!motion.stretched.empty()) record["stretched_bones"] = motion.stretched;
    for (const pbs::PartAngle& angle : motion.angles) record["angles_to_clip_deg"][angle.part] = angle.largest_deg;
    return record;
}

// [s] of finished frames whose rows an interruption may lose.
constexpr double longest_loss_s = 1.0;

// Prepares a scene, then for each frame: pose, deform, measure, write.
class SceneRun {
public:
    SceneRun(const Scene& scene, const std::string& folder, const Remarks& remarks, WhenInterrupted when_interrupted)
        : scene_(scene),
          finishes_early_(when_interrupted == WhenInterrupted::finish_early),
          remarks_(remarks),
          character_(cost_.time("character", [&] { return character_with_remarks(scene, remarks_); })),
          motion_(cost_.time("motion", [&] { return read_motion(scene, character_, remarks_); })),
          runners_(make_runners(scene, character_, cost_, folder, when_interrupted)),
          measurer_(cost_.time(
              "metrics_set_up",
              [&] { return FrameMeasurer(character_, measured_output(scene), prescribed_by_any(runners_)); })),
          reference_(scene, character_, runners_.front(), cost_),
          folder_(scene, character_, folder, motion_.motion.frames())
    {
        remarks_.add(pbs::Gravity::part_left_out, folder_.remarks());
        if (scene.output.surface && character_.surface && !measurer_.measures_surface_volume())
            remarks_.add(pbs::Gravity::information,
                         {scene.file +
                          ": surface_volume_change_pct is empty: the rendered surface is open or encloses no volume"});
        remarks_.add(remarks_on_set_up(scene, character_, runners_));
        remarks_.set_words_of_interruption(words_on_earlier_results());
    }

    RunResult run()
    {
        try {
            std::optional<NotedInterrupts> noted;
            if (finishes_early_) noted.emplace();
            foresee();
            play();
        } catch (const Interrupted&) {
            folder_.write_tables(true);
            if (frames_ > 0 && !words_on_earlier_results().empty()) warn({words_on_earlier_results()});
            if (frames_ > 0) folder_.keep_earlier_aside();
            throw;
        }
        return finish();
    }

private:
    const std::vector<pbs::Pose>& steps() const { return motion_.motion.steps; }
    bool is_frame(std::size_t step) const { return step % motion_.motion.steps_per_frame == 0; }

    // Deformers without memory work ahead, a reference within its budget of time.
    void foresee()
    {
        std::vector<pbs::Pose> frames;
        for (std::size_t step = 0; step < steps().size(); step += motion_.motion.steps_per_frame)
            frames.push_back(steps()[step]);
        if (scene_.reference_seconds > 0.0)
            spdlog::info("solving the reference: at most {:.0f} s of processor time for {} frames ...",
                         scene_.reference_seconds, frames.size());
        for (Runner& runner : runners_)
            cost_.time("step", runner.spec.label,
                       [&] { runner.deformer->foresee(runner.deformer->has_memory() ? steps() : frames); });
        reference_.note_contact();
        if (finishes_early_) reference_.give_up_when(interrupted);
    }

    void play()
    {
        Progress progress(scene_.name, static_cast<int>(steps().size()));
        const pbs::Stage stage(fmt::format("moving {} through {} frames", scene_.name, motion_.motion.frames()));
        pbs::Stopwatch since_tables;
        for (std::size_t step = 0; step < steps().size(); ++step) {
            advance(step);
            const bool has_finished_frames = frames_ > 0;
            if (finishes_early_ && has_finished_frames && take_interruption()) {  // this frame is not finished
                was_interrupted_ = true;
                return;
            }
            if (is_frame(step)) record_frame(static_cast<int>(step / motion_.motion.steps_per_frame), step);
            if (since_tables.seconds() > longest_loss_s) {
                folder_.write_tables(false);
                since_tables = {};
            }
            progress.advance_to(static_cast<int>(step) + 1);
        }
        was_interrupted_ = finishes_early_ && take_interruption();
    }

    // Deformers with memory get every step, the others only the frames.
    void advance(std::size_t step)
    {
        const pbs::Pose& pose = steps()[step];
        const double dt_s = motion_.motion.time_step_s;
        const auto takes_part = [&](const Runner& runner) { return is_frame(step) || runner.deformer->has_memory(); };
        for (Runner& runner : runners_)
            if (takes_part(runner))
                runner.steps.add(
                    cost_.time("step", runner.spec.label, [&] { return runner.deformer->advance(pose, dt_s); }), step);
        if (takes_part(runners_.front())) reference_.advance(pose, dt_s);
    }

    void record_frame(int frame, std::size_t step)
    {
        const pbs::Pose& pose = steps()[step];
        const double time_s = static_cast<double>(step) * motion_.motion.time_step_s;
        FrameContext context = reference_.context(frame, pose, measurer_);
        if (!motion_.motion.angle_deg.empty()) context.angle_deg = motion_.motion.angle_deg[frame];
        for (Runner& runner : runners_)
            if (runner.deformer->has_state()) record_deformer(runner, frame, time_s, context);
        if (frame == 0) remarks_.add(remarks_on_first_frame(scene_, character_, motion_, runners_, measurer_));
        if (scene_.output.writes(frame)) {
            folder_.write_pose(frame, time_s, character_.skeleton, pose);
            folder_.write_artist_skin(frame, time_s, character_, scene_.motion, pose);
        }
        ++frames_;
    }

    void record_deformer(Runner& runner, int frame, double time_s, FrameContext context)
    {
        const pbs::Positions& positions = runner.deformer->positions();
        pbs::StepSummary step = runner.steps.summary();
        // A reference that did not reach its pose is in another one, so that it has no error.
        const bool is_elsewhere = runner.traits.solves_equations && step.outcome == pbs::Outcome::not_converged;
        if (is_elsewhere) context.reference = nullptr;
        const FrameMeasurement measured = cost_.time("metrics", [&] { return measurer_.measure(positions, context); });
        // As readers refuse: products of such lengths may leave the range of a double.
        const bool has_volume =
            std::isfinite(measured.metrics.volume_change_pct) && positions.cwiseAbs().maxCoeff() <= pbs::farthest_m;
        if (!has_volume) step.outcome = pbs::Outcome::not_finite;
        cost_.time("records", [&] {
            folder_.add_frame(runner.spec, frame, time_s, measured, step);
            folder_.add_positions(runner.spec.label, positions);
        });
        if (has_volume && !is_elsewhere) runner.add_volume_change(measured.metrics.volume_change_pct);
        runner.most_inverted = std::max(runner.most_inverted, measured.metrics.inverted_tets);
        if (measured.error_below_reference_error() && runner.spec.name != scene_.reference)
            reference_.add_below_error(runner.spec.label);
        if (step.outcome != pbs::Outcome::finished || runner.has_inverted_flesh(measurer_))
            record_breakdown(runner, frame, step.outcome);
        if (scene_.output.writes(frame))
            cost_.time("frames", [&] {
                folder_.write_frame(runner.spec, frame, time_s, *context.pose, character_, positions, measurer_,
                                    prescribed_vertices(*runner.deformer));
            });
        runner.steps = {};
    }

    void record_breakdown(const Runner& runner, int frame, pbs::Outcome outcome)
    {
        const pbs::Positions positions =
            outcome == pbs::Outcome::not_converged ? last_state(*runner.deformer) : runner.deformer->positions();
        BrokenFrame broken = broken_frame(frame, outcome, positions, measurer_.volume_ratios(positions));
        const int step = static_cast<int>(runner.steps.worst_step());
        if (step != frame * motion_.motion.steps_per_frame) broken.step = step;
        broken_.add(runner.spec.label, broken, runner.traits.is_negative_control);
    }

    std::string words_on_earlier_results() const
    {
        const std::string earlier = folder_.earlier_results();
        return earlier.empty() ? "" : earlier + " keeps the results of the earlier run until another run finishes";
    }

    RunResult finish()
    {
        was_interrupted_ = was_interrupted_ || reference_.was_interrupted();
        nlohmann::json outcome = {{"finished", true}, {"frames", frames_}, {"motion", motion_record(motion_)}};
        outcome.update(broken_.record(frames_));
        outcome.update(reference_.record());
        remarks_.add(reference_.remarks());
        if (folder_.followed_skin().frame >= 0) {
            const CarriedSkin skin = carried_skin(character_, folder_.followed_skin());
            outcome["from_artist"] = skin;
            if (!motion_.is_far_from_clip()) remarks_.add(remarks_on(skin, scene_.file));
        }
        if (was_interrupted_) outcome["interrupted"] = true;
        if (const std::string words = folder_.words_on_left_out_frames(); !words.empty())
            remarks_.add(pbs::Gravity::information, {words});
        remarks_.say_all();
        outcome["warnings"] = remarks_.warnings();
        outcome["notes"] = remarks_.notes();
        outcome.update(run_end(stopwatch_.seconds()));
        std::map<std::string, nlohmann::json> records;
        for (const Runner& runner : runners_)
            if (const auto record = runner.deformer->record(); !record.is_null()) records[runner.spec.label] = record;
        if (was_interrupted_ && !words_on_earlier_results().empty()) warn({words_on_earlier_results()});
        folder_.finish(character_, records, outcome, cost_, reference_.error_method());
        remarks_.set_words_of_interruption("");
        return {frames_,   stopwatch_.seconds(), broken_.breakdown(), broken_.bad_frame(frames_),
                summary(), was_interrupted_};
    }

    std::vector<std::string> summary() const
    {
        std::vector<std::string> lines;
        for (const Runner& runner : runners_) lines.push_back(runner.summary(frames_));
        for (const auto& [label, frames] : broken_.frames_with(pbs::Outcome::not_converged))
            lines.push_back(
                fmt::format("  {:<12} did not converge in {} of {} frames; as a reference, it is not compared there",
                            label, frames.size(), frames_));
        return lines;
    }

    const Scene& scene_;
    bool finishes_early_, was_interrupted_ = false;
    RunRemarks remarks_;
    CostRecord cost_;
    pbs::Stopwatch stopwatch_;
    pbs::Character character_;
    CaseMotion motion_;
    std::vector<Runner> runners_;
    FrameMeasurer measurer_;
    ComparedReference reference_;
    RunFolder folder_;  // made after all that may refuse the scene, for it puts the records of an earlier run aside
    BrokenFrames broken_;
    int frames_ = 0;
};

}  // namespace

RunResult run_scene(const Scene& scene, const std::string& folder, const Remarks& remarks,
                    WhenInterrupted when_interrupted, std::optional<pbs::SourceFile> model)
{
    std::optional<pbs::Stage> preparing("preparing " + scene.name);
    // the character, the motion and the materials are read from it
    if (!model) model.emplace(scene.character.model_file);
    SceneRun run(scene, folder, remarks, when_interrupted);
    model.reset();
    preparing.reset();
    return run.run();
}

}  // namespace experiments
