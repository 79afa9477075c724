#include "experiments/run/run.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/run/parts_of_one_bone.hpp"
#include "experiments/run/reference_error_bar.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/run/run_remarks.hpp"
#include "experiments/run/spread_reference.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/character/body_cache.hpp"
#include "pbs/character/separated_parts.hpp"
#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/solver/step_summary.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <memory>
#include <set>

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

// One deformer of the run, and its steps since the last frame.
struct Runner {
    DeformerSpec spec;
    DeformerTraits traits;
    std::unique_ptr<Deformer> deformer;
    pbs::FrameStep steps = {};
    double lowest_change_pct = std::numeric_limits<double>::infinity(), highest_change_pct = -lowest_change_pct;
    int most_inverted = 0;
};

// All that the reference's frames depend on, except for their poses.
std::string reference_key(const DeformerSpec& spec, const pbs::Character& character)
{
    const nlohmann::json settings = {to_json(spec), pbs::hash_of_file(load_module_with_blas("pbskin_fem").path()),
                                     pbs::content_hash(character.mesh), pbs::hashes_by_name(character.inputs)};
    analysis::StateHash hash;
    const auto add = [&](const auto* data, std::size_t size) { hash.add_bytes(data, size * sizeof *data); };
    for (const pbs::Bone& bone : character.skeleton.bones) add(bone.head.data(), 3), add(bone.tail.data(), 3), add(&bone.parent, 1);
    for (const pbs::Weights* weights : {&character.weights, character.artist ? &character.artist->weights : nullptr})
        if (weights) add(weights->bone.data(), weights->bone.size()), add(weights->weight.data(), weights->weight.size());
    return pbs::content_hash(settings.dump() + hash.hex());
}

std::unique_ptr<Deformer> deformer_of(const DeformerSpec& spec, const Scene& scene, const pbs::Character& character,
                                      const std::string& folder, WhenInterrupted when_interrupted)
{
    if (scene.reference_seconds == 0.0 || spec.name != scene.reference) return make_deformer(spec);
    const ReferenceBudget budget{scene.reference_seconds, folder + "/reference_frames.cbor", reference_key(spec, character),
                                 when_interrupted == WhenInterrupted::finish_early};
    return std::make_unique<SpreadReference>(spec, budget);
}

std::vector<Runner> make_runners(const Scene& scene, const pbs::Character& character, CostRecord& cost, const std::string& folder,
                                 WhenInterrupted when_interrupted)
{
    std::vector<Runner> runners;
    for (const DeformerSpec& spec : scene.deformers) {
        cost.time("set_up", spec.label, [&] {
            const pbs::Stage stage("setting up " + spec.label);
            runners.push_back({spec, traits_of(spec), deformer_of(spec, scene, character, folder, when_interrupted)});
            runners.back().deformer->reset(character);
        });
    }
    // The reference moves first, so that a frame's errors can be measured.
    std::stable_partition(runners.begin(), runners.end(), [&](const Runner& runner) { return runner.spec.name == scene.reference; });
    return runners;
}

// Vertices whose positions any of the deformers is given, #V; empty: none. Errors leave them out.
std::vector<bool> prescribed_by_any(const std::vector<Runner>& runners)
{
    std::vector<bool> any;
    for (const Runner& runner : runners) {
        const std::vector<bool> own = prescribed_vertices(*runner.deformer);
        if (any.size() < own.size()) any.resize(own.size(), false);
        for (std::size_t v = 0; v < own.size(); ++v) any[v] = any[v] || own[v];
    }
    return any;
}

void refuse_frames_beyond(const pbs::Motion& motion, const Scene& scene)
{
    for (const int frame : scene.output.frames)
        if (frame >= motion.frames())
            throw pbs::InputError(scene.file, 0, "output.frames", std::to_string(frame),
                                  fmt::format("expected less than the motion's {} frames", motion.frames()));
}

// Without a reference no errors can be measured.
OutputSpec measured_output(const Scene& scene)
{
    OutputSpec output = scene.output;
    output.errors = output.errors && !scene.reference.empty();
    return output;
}

constexpr double many_inverted_pct = 1.0;    // of the tets, in the first frame
constexpr double far_from_artist_pct = 2.0;  // of the model's size
constexpr double much_lag_deg = 5.0;         // of a part that one bone alone moves

// The rendered surface is needed if it is measured or written.
pbs::Character character_with_remarks(const Scene& scene, RunRemarks& remarks)
{
    pbs::CharacterSource source = scene.character;
    source.surface = scene.output.surface || scene.output.frames_every > 0 || !scene.output.frames.empty();
    pbs::RemarkList found;
    pbs::Character character = pbs::make_character(source, found);
    remarks.add(found);
    return character;
}

// Reads the motion, and adds the hashes of its clip to the character's inputs; a sweep has no clip.
CaseMotion read_motion(const Scene& scene, pbs::Character& character, RunRemarks& remarks)
{
    const pbs::InputFile clip(scene.motion.clip);
    CaseMotion motion = make_case_motion(scene.motion, character, scene.file);
    remarks.add(motion.remarks);
    remarks.add(pbs::Gravity::information, motion.notes);
    if (scene.motion.clip.empty()) return motion;
    for (const auto& hashed : clip.hashed()) character.inputs.push_back(hashed);
    return motion;
}

// [s] of finished frames whose rows an interruption may lose.
constexpr double longest_loss_s = 1.0;

class SceneRun {
public:
    SceneRun(const Scene& scene, const std::string& folder, const Remarks& remarks, WhenInterrupted when_interrupted)
        : scene_(scene),
          when_interrupted_(when_interrupted),
          remarks_(remarks),
          character_(cost_.time("character", [&] { return character_with_remarks(scene, remarks_); })),
          motion_case_(cost_.time("motion", [&] { return read_motion(scene, character_, remarks_); })),
          motion_(motion_case_.motion),
          runners_(make_runners(scene, character_, cost_, folder, when_interrupted)),
          measurer_(
              cost_.time("metrics_set_up", [&] { return FrameMeasurer(character_, measured_output(scene), prescribed_by_any(runners_)); })),
          folder_((refuse_frames_beyond(motion_, scene), scene), character_, folder, motion_.frames())
    {
        remarks_.add(pbs::Gravity::part_left_out, folder_.remarks());
        if (scene.output.surface && character_.surface && !measurer_.measures_surface_volume())
            remarks_.add(pbs::Gravity::information,
                         {scene.file + ": surface_volume_change_pct is empty: the rendered surface is open or encloses no volume"});
        warn_of_bones_without_flesh();
        warn_of_weakened_slivers();
        if (scene.error_bar != ErrorBar::none)
            cost_.time("error_bar_set_up", [&] { error_bar_.emplace(runners_.front().spec, character_); });
    }

    RunResult run()
    {
        try {
            play();
        } catch (const Interrupted&) {
            folder_.write_tables(true);
            throw;
        }
        return finish();
    }

private:
    // A root on the ground, from which a rig hangs, is such a bone.
    void warn_of_bones_without_flesh()
    {
        for (const Runner& runner : runners_) {
            const nlohmann::json record = runner.deformer->record();
            const nlohmann::json::json_pointer bones("/attachment/bones");
            if (!record.contains(bones)) continue;
            std::vector<std::string> without;
            for (const nlohmann::json& grip : record.at(bones))
                if (grip.value("tets_gripped", 1) == 0) without.push_back(grip.at("bone").get<std::string>());
            if (!without.empty())
                remarks_.add(pbs::Gravity::part_left_out,
                             {fmt::format("{}: {} leaves out {} of {} bones, whose middle lies outside the flesh: {}", scene_.file,
                                          runner.spec.label, without.size(), character_.skeleton.bones.size(), pbs::name_list(without))});
        }
    }

    void warn_of_weakened_slivers()
    {
        std::vector<std::string> labels;
        int slivers = 0;
        for (const Runner& runner : runners_) {
            const nlohmann::json record = runner.deformer->record();
            if (!record.contains("weakened_slivers")) continue;
            slivers = record.at("weakened_slivers").get<int>();
            labels.push_back(runner.spec.label);
        }
        if (!labels.empty())
            remarks_.add(pbs::Gravity::part_left_out,
                         {fmt::format("{}: {} of {} tets are slivers, whose volume is below 1e-5 of their longest edge cubed: {} could not "
                                      "turn them, and take them as soft as regular tets; remesh the body, or leave these tets out",
                                      scene_.file, slivers, character_.mesh.tets.rows(), fmt::join(labels, ", "))});
    }

    void play()
    {
        const bool finishes_early = when_interrupted_ == WhenInterrupted::finish_early;
        std::optional<NotedInterrupts> noted;
        if (finishes_early) noted.emplace();
        std::vector<pbs::Pose> frames;
        for (std::size_t step = 0; step < motion_.steps.size(); step += motion_.steps_per_frame) frames.push_back(motion_.steps[step]);
        if (scene_.reference_seconds > 0.0)
            spdlog::info("solving the reference: at most {:.0f} s of processor time for {} frames ...", scene_.reference_seconds,
                         frames.size());
        for (Runner& runner : runners_)
            cost_.time("step", runner.spec.label,
                       [&] { runner.deformer->foresee(runner.deformer->has_memory() ? motion_.steps : frames); });
        if (const SpreadReference::Outcome* spread = spread_reference(); spread && spread->with_contact)
            options_of<FemOptions>(runners_.front().spec).contact = false;
        if (finishes_early) runners_.front().deformer->give_up_when(interrupted);
        if (finishes_early && error_bar_) error_bar_->give_up_when(interrupted);
        Progress progress(scene_.name, static_cast<int>(motion_.steps.size()));
        std::optional<pbs::Stage> stage;
        if (!finishes_early) stage.emplace(fmt::format("moving {} through {} frames", scene_.name, frames.size()));
        pbs::Stopwatch since_tables;
        for (std::size_t step = 0; step < motion_.steps.size(); ++step) {
            if (!finishes_early) stop_if_interrupted();
            const bool is_frame = step % motion_.steps_per_frame == 0;
            for (Runner& runner : runners_)
                if (is_frame || runner.deformer->has_memory())
                    runner.steps.add(cost_.time("step", runner.spec.label,
                                                [&] { return runner.deformer->advance(motion_.steps[step], motion_.time_step_s); }),
                                     step);
            if (error_bar_ && (is_frame || runners_.front().deformer->has_memory()))
                cost_.time("error_bar", [&] { error_bar_->advance(motion_.steps[step], motion_.time_step_s); });
            const bool has_finished_frames = frames_ > 0;
            if (finishes_early && has_finished_frames && take_interruption()) {  // this frame is not finished
                was_interrupted_ = true;
                return;
            }
            if (is_frame) record_frame(static_cast<int>(step / motion_.steps_per_frame), step);
            if (since_tables.seconds() > longest_loss_s) {
                folder_.write_tables(false);
                since_tables = {};
            }
            progress.advance_to(static_cast<int>(step) + 1);
        }
        was_interrupted_ = finishes_early && take_interruption();
    }

    void record_frame(int frame, std::size_t step)
    {
        const double time_s = static_cast<double>(step) * motion_.time_step_s;
        FrameContext context;
        context.pose = &motion_.steps[step];
        if (!motion_.angle_deg.empty()) context.angle_deg = motion_.angle_deg[frame];
        const Runner& first = runners_.front();
        if (scene_.output.errors && first.spec.name == scene_.reference && first.deformer->has_state() && can_be_compared_with(first)) {
            context.reference = &first.deformer->positions();
            cost_.time("metrics", [&] {
                const FemFacts* facts = first.deformer->facts();
                largest_masked_share_pct_ =
                    std::max(largest_masked_share_pct_, measurer_.leave_out(facts ? facts->tips : std::vector<CreaseTip>()));
                const auto* fem = options_if<FemOptions>(first.spec);
                if ((fem && fem->has_contact()) || !measurer_.overlaps(*context.reference)) return;
                if (frames_with_overlap_++ == 0) first_frame_with_overlap_ = frame;
            });
            cost_.time("metrics", [&] { find_lag(frame, *context.reference, motion_.steps[step]); });
            if (error_bar_) cost_.time("error_bar", [&] { context.reference_error = error_bar_->bound(*context.reference, measurer_); });
        }
        for (Runner& runner : runners_)
            if (runner.deformer->has_state()) record_deformer(runner, frame, time_s, context);
        if (frame == 0) remark_on_inverted_start();
        if (frame == 0) remark_on_followed_motion();
        if (scene_.output.writes(frame)) {
            folder_.write_pose(frame, time_s, character_.skeleton, motion_.steps[step]);
            folder_.write_artist_skin(frame, time_s, character_, scene_.motion, motion_.steps[step]);
        }
        ++frames_;
    }

    // Blending that inverts many tets in the first frame, before anything has moved far, points to a rest pose that is not the model's.
    void remark_on_inverted_start()
    {
        if (!scene_.character.body.empty()) return;   // made with its skeleton
        if (motion_case_.is_far_from_clip()) return;  // which a warning names as the cause
        std::vector<std::string> counts;
        int most = 0;
        for (const Runner& runner : runners_) {
            if (!traits_of(runner.spec).blends_linearly || runner.most_inverted == 0) continue;
            counts.push_back(fmt::format("{} has {}", runner.spec.label, runner.most_inverted));
            most = std::max(most, runner.most_inverted);
        }
        if (counts.empty()) return;
        const Eigen::Index tets = character_.mesh.tets.rows();
        const std::string text =
            fmt::format("{}: {} inverted tets in the first frame, of {}", scene_.file, fmt::join(counts, " and "), tets);
        if (most > many_inverted_pct / 100.0 * static_cast<double>(tets))
            remarks_.add(pbs::Gravity::results_wrong,
                         {text + ": its pose is far from the bind pose, or the weights do not fit the joints"});
        else
            remarks_.add(pbs::Gravity::information, {text});
    }

    // Which deformers follow a far motion from rest, and what stays caught: how many tets, and the bone that moves most of them.
    void remark_on_followed_motion()
    {
        if (!scene_.character.body.empty()) return;
        for (const Runner& runner : runners_) {
            if (const nlohmann::json record = runner.deformer->record(); record.is_object() && record.contains("follows_from_rest"))
                remarks_.add(pbs::Gravity::information,
                             {fmt::format("{}: the first frame turns a joint by more than 90 degrees from the bind pose: {} goes to "
                                          "each frame in steps from there",
                                          scene_.file, runner.spec.label)});
            if (!runner.traits.iterations || runner.traits.solves_equations || runner.most_inverted == 0) continue;
            const Eigen::VectorXd ratios = measurer_.volume_ratios(runner.deformer->positions());
            std::vector<double> share(character_.skeleton.bones.size());
            for (Eigen::Index tet = 0; tet < ratios.size(); ++tet)
                for (const int v : character_.mesh.tets.row(tet))
                    for (int e = character_.weights.first[v]; ratios(tet) <= 0.0 && e < character_.weights.first[v + 1]; ++e)
                        share[character_.weights.bone[e]] += character_.weights.weight[e];
            const auto most = std::ranges::max_element(share) - share.begin();
            remarks_.add(
                pbs::Gravity::information,
                {fmt::format("{}: {} begins with {} inverted tets, most of them at {}: what is caught in the first frame may stay so",
                             scene_.file, runner.spec.label, runner.most_inverted, character_.skeleton.bones[most].name)});
        }
    }

    void find_lag(int frame, const pbs::Positions& reference, const pbs::Pose& pose)
    {
        if (!parts_) parts_.emplace(character_);
        PartLag lag = parts_->largest_lag(reference, pose);
        lag.frame = frame;
        if (lag.bone >= 0 && (lag_.bone < 0 || lag.turn_deg > lag_.turn_deg)) lag_ = lag;
    }

    // A head that is longer than its bone is not held by springs around the bone.
    nlohmann::json record_lag()
    {
        if (lag_.bone < 0) return nullptr;
        const std::string& bone = character_.skeleton.bones[static_cast<std::size_t>(lag_.bone)].name;
        if (lag_.turn_deg > much_lag_deg)
            remarks_.add(
                pbs::Gravity::comparison_wrong,
                {fmt::format("{}: in the reference, the flesh that {} alone moves is turned by up to {:.0f} degrees against it, in "
                             "frame {}; attachment = \"held\" of [[fem]] ties such flesh to its bone",
                             scene_.file, bone, lag_.turn_deg, lag_.frame)});
        return {{"largest_turn_deg", lag_.turn_deg}, {"bone", bone}, {"frame", lag_.frame}};
    }

    // Null: the reference has no budget.
    const SpreadReference::Outcome* spread_reference() const
    {
        const auto* reference = dynamic_cast<const SpreadReference*>(runners_.front().deformer.get());
        return reference ? &reference->outcome() : nullptr;
    }

    // Records which frames the reference solved within its budget, and remarks on those that it did not.
    nlohmann::json record_reference_frames()
    {
        const SpreadReference::Outcome* outcome = spread_reference();
        if (!outcome) return nullptr;
        was_interrupted_ = was_interrupted_ || outcome->was_interrupted;
        remarks_.add(remarks_on(*outcome, scene_.file));
        nlohmann::json record = *outcome;
        record["budget_s"] = scene_.reference_seconds;
        return record;
    }

    void warn_of_overlap()
    {
        if (frames_with_overlap_ > 0)
            remarks_.add(pbs::Gravity::comparison_wrong,
                         {fmt::format("{}: the reference passes through itself in {} of {} frames, first in frame {}, and has no contact: "
                                      "errors compare with that",
                                      scene_.file, frames_with_overlap_, frames_, first_frame_with_overlap_)});
    }

    // How well the tets carry the artist's surface. Parts that they weld together follow the wrong bone.
    nlohmann::json record_followed_skin()
    {
        const RunFolder::FollowedSkin& followed = folder_.followed_skin();
        if (followed.frame < 0) return nullptr;
        const pbs::Positions& rest = character_.artist->model->body.surface;
        const double size_m = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm(), pct = 100.0 * followed.largest_m / size_m;
        const pbs::Carrier carrier = pbs::carrier_of(character_, followed.vertex);
        const auto& bones = character_.skeleton.bones;
        const auto name = [&](int bone) { return bones[static_cast<std::size_t>(bone)].name; };
        const auto parent = [&](int bone) { return bones[static_cast<std::size_t>(bone)].parent; };
        const bool at_a_joint =
            carrier.bone == carrier.of_flesh || parent(carrier.bone) == carrier.of_flesh || parent(carrier.of_flesh) == carrier.bone;
        if (pct > far_from_artist_pct && !motion_case_.is_far_from_clip())
            remarks_.add(
                pbs::Gravity::results_wrong,
                {fmt::format("{}: the surface that LBS carries with the tets is up to {:.1f} % of the model's size away from the "
                             "artist's, in frame {}: ",
                             scene_.file, pct, followed.frame) +
                 (at_a_joint ? fmt::format("the tets at {} are too coarse for its weights; --vertices (character.vertices in a scene) asks "
                                           "for more",
                                           name(carrier.bone))
                             : fmt::format("there the flesh of {} carries the surface of {}, with a gap of {:.2g} % of that size at rest",
                                           name(carrier.of_flesh), name(carrier.bone), 100.0 * carrier.gap_m / size_m))});
        return {{"largest_pct", pct},
                {"frame", followed.frame},
                {"bone", name(carrier.bone)},
                {"bone_of_flesh", name(carrier.of_flesh)},
                {"gap_mm", 1e3 * carrier.gap_m}};
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
        const bool has_volume = std::isfinite(measured.metrics.volume_change_pct) && positions.cwiseAbs().maxCoeff() <= pbs::farthest_m;
        if (!has_volume) step.outcome = pbs::Outcome::not_finite;
        cost_.time("records", [&] {
            folder_.add_frame(runner.spec, frame, time_s, measured, step);
            folder_.add_positions(runner.spec.label, positions);
        });
        if (has_volume && !is_elsewhere) {
            runner.lowest_change_pct = std::min(runner.lowest_change_pct, measured.metrics.volume_change_pct);
            runner.highest_change_pct = std::max(runner.highest_change_pct, measured.metrics.volume_change_pct);
        }
        runner.most_inverted = std::max(runner.most_inverted, measured.metrics.inverted_tets);
        if (measured.error_below_reference_error() && runner.spec.name != scene_.reference)
            ++frames_below_reference_error_[runner.spec.label];
        if (step.outcome == pbs::Outcome::not_converged) not_converged_[runner.spec.label].push_back(frame);
        if (step.outcome == pbs::Outcome::not_finite) breakdowns_[runner.spec.label].push_back(frame);
        if (step.outcome != pbs::Outcome::finished || has_inverted_flesh(runner)) record_breakdown(runner, frame, step.outcome);
        if (scene_.output.writes(frame))
            cost_.time("frames", [&] {
                folder_.write_frame(runner.spec, frame, time_s, character_, positions, measurer_, prescribed_vertices(*runner.deformer));
            });
        runner.steps = {};
    }

    // Curved elements are judged at their quadrature points, since their vertices alone may form an inverted tet.
    bool has_inverted_flesh(const Runner& runner) const
    {
        if (!runner.traits.solves_equations) return false;
        const FemFacts* facts = runner.deformer->facts();
        const std::optional<double> lowest_det_f = facts ? facts->lowest_det_f : std::nullopt;
        return lowest_det_f.value_or(measurer_.volume_ratios(runner.deformer->positions()).minCoeff()) <= 0.0;
    }

    // No deformer is compared with inverted flesh. The linear model is a negative control, which inverts tets at large rotations.
    bool can_be_compared_with(const Runner& reference) const
    {
        return reference.steps.summary().outcome == pbs::Outcome::finished &&
               (reference.traits.is_negative_control || !has_inverted_flesh(reference));
    }

    void record_breakdown(const Runner& runner, int frame, pbs::Outcome outcome)
    {
        const pbs::Positions positions =
            outcome == pbs::Outcome::not_converged ? last_state(*runner.deformer) : runner.deformer->positions();
        BrokenFrame broken = broken_frame(frame, outcome, positions, measurer_.volume_ratios(positions));
        if (const int step = static_cast<int>(runner.steps.worst_step()); step != frame * motion_.steps_per_frame) broken.step = step;
        broken_frames_[runner.spec.label].push_back(broken);
        if (runner.traits.is_negative_control) return;
        const std::string text = fmt::format("{} is {}", runner.spec.label, text_of(broken));
        if (outcome == pbs::Outcome::not_finite) {
            if (breakdown_.empty()) breakdown_ = text;
        } else {
            if (bad_frame_.empty())
                bad_frame_ = fmt::format("{}: {}", outcome == pbs::Outcome::finished ? "inverted tets" : "pose not reached", text);
            bad_labels_.insert(runner.spec.label);
        }
    }

    RunResult finish()
    {
        std::map<std::string, nlohmann::json> records;
        for (const Runner& runner : runners_)
            if (const auto record = runner.deformer->record(); !record.is_null()) records[runner.spec.label] = record;
        std::vector<std::string> bad_frames;  // "3 of 31 frames of nh_p1"
        for (const std::string& label : bad_labels_)
            bad_frames.push_back(fmt::format("{} of {} frames of {}", broken_frames_.at(label).size(), frames_, label));
        if (!bad_frame_.empty()) bad_frame_ += fmt::format("; {} broke down", fmt::join(bad_frames, ", "));
        nlohmann::json outcome = {{"finished", true}, {"frames", frames_}, {"breakdowns", breakdowns_}, {"not_converged", not_converged_}};
        outcome["broken_frames"] = broken_frames_;
        outcome["breakdown"] = breakdown_;
        outcome["bad_frame"] = bad_frame_;
        if (!scene_.reference.empty()) {
            outcome["frames_with_overlap"] = frames_with_overlap_;
            outcome["largest_masked_share_pct"] = largest_masked_share_pct_;
            outcome["reference_lag"] = record_lag();
            outcome["reference_frames"] = record_reference_frames();
        }
        if (error_bar_) outcome["frames_below_reference_error"] = frames_below_reference_error_;
        warn_of_overlap();
        if (const nlohmann::json followed = record_followed_skin(); !followed.is_null()) outcome["from_artist"] = followed;
        if (was_interrupted_) outcome["interrupted"] = true;
        if (const std::string words = folder_.words_on_left_out_frames(); !words.empty()) remarks_.add(pbs::Gravity::information, {words});
        remarks_.say_all();
        outcome["warnings"] = remarks_.warnings();
        outcome["notes"] = remarks_.notes();
        outcome["motion"] = {{"largest_rotation_deg", motion_case_.largest_rotation_deg},
                             {"time_zero", motion_case_.time_zero},
                             {"time_zero_s", motion_case_.time_zero_s}};
        if (motion_case_.clip_joints > 0)
            outcome["motion"].update({{"clip_joints", motion_case_.clip_joints}, {"matched_joints", motion_case_.matched_joints}});
        if (!motion_case_.stretched.empty()) outcome["motion"]["stretched_bones"] = motion_case_.stretched;
        for (const pbs::PartAngle& angle : motion_case_.angles) outcome["motion"]["angles_to_clip_deg"][angle.part] = angle.largest_deg;
        outcome.update(run_end(stopwatch_.seconds()));
        folder_.finish(character_, records, outcome, cost_, error_bar_ ? error_bar_->method() : nlohmann::json());

        RunResult result{frames_, stopwatch_.seconds(), breakdown_, bad_frame_, {}, was_interrupted_};
        for (const Runner& runner : runners_)
            result.lines.push_back(
                runner.lowest_change_pct > runner.highest_change_pct
                    ? fmt::format("  {:<12} reached none of {} poses, so that it has no volume change", runner.spec.label, frames_)
                    : fmt::format("  {:<12} volume change {:8.3f} to {:7.3f} %, at most {} inverted tets", runner.spec.label,
                                  runner.lowest_change_pct, runner.highest_change_pct, runner.most_inverted));
        for (const auto& [label, frames] : not_converged_)
            result.lines.push_back(fmt::format("  {:<12} did not converge in {} of {} frames; as a reference, it is not compared there",
                                               label, frames.size(), frames_));
        return result;
    }

    const Scene& scene_;
    WhenInterrupted when_interrupted_;
    bool was_interrupted_ = false;
    RunRemarks remarks_;
    CostRecord cost_;
    pbs::Stopwatch stopwatch_;
    pbs::Character character_;
    CaseMotion motion_case_;
    const pbs::Motion& motion_;
    std::vector<Runner> runners_;
    FrameMeasurer measurer_;
    std::optional<ReferenceErrorBar> error_bar_;
    std::optional<PartsOfOneBone> parts_;  // from the first frame of a reference
    PartLag lag_;                          // the largest one
    RunFolder folder_;                     // made last, for it removes the records of an earlier run
    int frames_ = 0, frames_with_overlap_ = 0, first_frame_with_overlap_ = 0;
    double largest_masked_share_pct_ = 0.0;
    std::string breakdown_, bad_frame_;
    std::set<std::string> bad_labels_;                                    // of the deformers with bad frames
    std::map<std::string, std::vector<int>> breakdowns_, not_converged_;  // label -> frames
    std::map<std::string, std::vector<BrokenFrame>> broken_frames_;       // label -> frames with their worst elements
    std::map<std::string, int> frames_below_reference_error_ = {};        // label -> how many
};

}  // namespace

RunResult run_scene(const Scene& scene, const std::string& folder, const Remarks& remarks, WhenInterrupted when_interrupted)
{
    std::optional<pbs::Stage> preparing("preparing " + scene.name);
    SceneRun run(scene, folder, remarks, when_interrupted);
    preparing.reset();
    return run.run();
}

}  // namespace experiments
