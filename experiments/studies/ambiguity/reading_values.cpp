#include "experiments/studies/ambiguity/reading_values.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/momentum/momentum_drift.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/character/overlap_and_jiggle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace experiments {
namespace {

template <typename Measure>
std::vector<ReadingValues> of_each(const std::vector<Reading>& readings, const Measure& measure)
{
    std::vector<ReadingValues> all;
    for (const Reading& reading : readings) all.push_back(measure(reading));
    return all;
}

// The body of a case and its motion.
struct MovedBody {
    explicit MovedBody(const ReadingsCase& of)
        : character(pbs::make_character(of.scene.character)), motion(make_motion(of.scene.motion, character.skeleton, of.scene.file))
    {
    }

    const pbs::Pose& pose_at(int frame) const { return motion.steps.at(static_cast<std::size_t>(frame) * motion.steps_per_frame); }

    pbs::Character read(const Reading& reading) const
    {
        pbs::Character own = character;
        own.weights = weights_of(character, reading);
        return own;
    }

    pbs::Character character;
    pbs::Motion motion;
};

ConvergencePaths paths_of(const ReadingsCase& of, const MovedBody& body, const Reading& reading)
{
    const pbs::Character character = body.read(reading);
    const FrameStarts starts = starts_of(character, body.motion, {of.frame}, reading.options).front();
    const pbs::Positions bind_points = bind_points_of(character, reading, body.pose_at(of.frame), starts.shapes.front());
    ConvergencePaths paths;
    paths.of.body = of.scene.character.body;
    paths.of.pose = of.pose;
    paths.key = of.key;
    paths.of.vertices = static_cast<int>(character.mesh.rest.rows());
    paths.of.tets = static_cast<int>(character.mesh.tets.rows());
    paths.of.order = name_of(reading.options.order);
    paths.of.precision = name_of(reading.options.precision);
    paths.character = !of.scene.motion.clip.empty();
    paths.paths = iterate(character, reading.options, bind_points, {starts.shapes.begin(), starts.shapes.end()}, of.most_iterations,
                          IterationMetrics(character, bind_points));
    return paths;
}

bool are_finite(const std::vector<IterationPath>& paths)
{
    return std::ranges::all_of(paths, &IterationPath::finite);
}

Reading jolted(Reading reading, double k_stretch, int iterations)
{
    const bool everywhere = reading.options.jiggle && reading.options.k_stretch == reading.options.jiggle->k_stretch;
    if (!reading.options.jiggle) reading.options.jiggle = pbs::Jiggle{};
    reading.options.jiggle->k_stretch = k_stretch;
    if (everywhere) reading.options.k_stretch = k_stretch;
    reading.options.iterations = iterations;
    reading.options.gravity_m_s2.setZero();
    return reading;
}

// named: the setting under which the values are recorded, which is the paper's, whatever the reading makes of it.
MeasuredJiggle jolt(const MovedBody& body, const std::vector<int>& probe, const ReadingsCase& of, const Reading& reading,
                    const JiggleSetting& named, double k_stretch)
{
    ReadDeformer deformer(jolted(reading, k_stretch, named.iterations));
    Jolt jolt{.direction = of.jolt_direction, .time_step_s = named.time_step_s / reading.substeps, .steps = of.jolt_steps};
    jolt.still_steps *= reading.substeps;
    jolt.steps *= reading.substeps;
    MeasuredJiggle measured{named, jolt_response(body.character, deformer, probe, jolt)};
    if (measured.response.peak_over_jolt < least_answer) measured.response.swing = {};
    return measured;
}

std::vector<MeasuredJiggle> jolts_of(const ReadingsCase& of, const MovedBody& body, const std::vector<int>& probe, const Reading& reading)
{
    const int iterations = reading.options.iterations;
    const double dt_s = of.scene.motion.time_step_s, k = reading.options.jiggle ? reading.options.jiggle->k_stretch : table_1_k_stretch;
    return {jolt(body, probe, of, reading, {table_1_k_stretch, dt_s, iterations}, k),
            jolt(body, probe, of, reading, {soft_k_stretch, dt_s, iterations}, soft_k_stretch),
            jolt(body, probe, of, reading, {table_1_k_stretch, 0.5 * dt_s, iterations}, k),
            jolt(body, probe, of, reading, {table_1_k_stretch, dt_s, 2 * iterations}, k)};
}

// Quantities that are computed from one setting or two, so that few settings give them as well as many.
const std::vector<std::string> quantities_of_few_settings = {"damping_ratio", "frequency_ratio_at_half_time_step",
                                                             "frequency_ratio_at_twice_iterations"};

ReadingValues of_jolts(const std::string& body, const std::vector<MeasuredJiggle>& measured)
{
    const std::vector<JiggleSetting> all = jiggle_settings();
    const std::string reason = fmt::format("the bound is for the study's {} settings, a reading is jolted at {}",
                                           std::ranges::count_if(all, is_of_the_paper), measured.size());
    ReadingValues read = {judged(jiggle_values(body, measured)), false, all_but("C09", quantities_of_few_settings, reason)};
    std::erase_if(read.values, [&](const JudgedValue& value) {
        return std::ranges::find(read.left_out, value.quantity, &LeftOutQuantity::quantity) != read.left_out.end();
    });
    read.broke_down = !std::ranges::all_of(measured, [](const MeasuredJiggle& one) { return one.response.finished; });
    return read;
}

// One reading's way through the motion, one frame per turn.
class TimedReading {
public:
    TimedReading(const MovedBody& body, Reading reading, double dt_s)
        : motion_(body.motion), substeps_(reading.substeps), dt_s_(dt_s), deformer_(judged_precision(std::move(reading)))
    {
        deformer_.reset(body.character);
    }

    std::vector<double> turn()
    {
        stop_if_interrupted();
        const pbs::Pose& pose = motion_.steps[next_];
        next_ = (next_ + static_cast<std::size_t>(motion_.steps_per_frame)) % motion_.steps.size();
        const double start_s = thread_cpu_s();
        for (int substep = 0; substep < substeps_; ++substep) deformer_.advance(pose, dt_s_ / substeps_);
        const double took_s = thread_cpu_s() - start_s;
        finite_ = finite_ && deformer_.positions().allFinite();
        return {took_s};
    }

    bool finite() const { return finite_; }  // in every turn

private:
    static Reading judged_precision(Reading reading)
    {
        reading.options.order = pbs::Order::plain;
        reading.options.precision = pbs::Precision::f64;
        return reading;
    }

    const pbs::Motion& motion_;
    int substeps_;
    double dt_s_;
    ReadDeformer deformer_;
    std::size_t next_ = 0;
    bool finite_ = true;
};

JudgedValue of_frame(const std::string& body, int vertices, double ms)
{
    const analysis::Claim& claim = claim_named("C10");
    const double frames_s = 1e3 / ms;
    const analysis::Measurement pace{"C10", claim.metrics.front(), {}, frames_s, frames_s, frames_s, "1/s"};
    return {"C10",
            "processor_time_of_a_frame_ms",
            {.body = body, .order = "plain", .precision = "f64", .vertices = vertices},
            "ms",
            fmt::format("{} frames per second", analysis::bound_text(analysis::bound_of(claim, pace.quantity))),
            ms,
            analysis::extent_of(claim, pace)};
}

}  // namespace

std::vector<ReadingValues> values_of_starts(const ReadingsCase& of, const std::vector<Reading>& readings)
{
    const MovedBody body(of);
    return of_each(readings, [&](const Reading& reading) {
        ConvergenceResult result;
        result.all.push_back(paths_of(of, body, reading));
        result.all.front().of.k_stretch = readings.front().options.k_stretch;  // names the case, alike for all readings
        ReadingValues read = {judged(convergence_values(result)), !are_finite(result.all.front().paths)};
        if (!result.all.front().character) read.left_out = all_but("C12", {}, "judged on characters alone");
        return read;
    });
}

std::vector<ReadingValues> values_of_projections(const ReadingsCase& of, const std::vector<Reading>& readings)
{
    const MovedBody body(of);
    return of_each(readings, [&](const Reading& reading) {
        const pbs::Character character = body.read(reading);
        const pbs::Pose& pose = body.pose_at(of.frame);
        std::vector<analysis::Measurement> values;
        const auto add = [&](const char* which, const std::string& name, double drift) {
            analysis::CaseKey key = of.key;
            key.body = of.scene.character.body;
            key.constraint = which;
            values.push_back({"C07", name, key, drift, drift, drift, "1"});
        };
        for (const auto& [projected, which] :
             {std::pair{ProjectedClass::stretch, "stretch"}, std::pair{ProjectedClass::volume, "volume"}}) {
            const MomentumDrift single = drift_of_projections(character, pose, reading.options, projected, reading.options.masses);
            const MomentumDrift pass = drift_of_a_pass(character, pose, reading.options, projected, reading.options.masses);
            add(which, "linear_drift", single.linear);
            add(which, "angular_drift", single.angular);
            add(which, "linear_drift_of_a_pass", pass.linear);
            add(which, "angular_drift_of_a_pass", pass.angular);
        }
        return ReadingValues{judged(values), false};
    });
}

std::vector<ReadingValues> values_of_jolts(const ReadingsCase& of, const std::vector<Reading>& readings)
{
    const MovedBody body(of);
    const std::vector<int> probe = zone_contents(body.character).pieces.at(0);
    return of_each(readings, [&](const Reading& reading) { return of_jolts(of.scene.character.body, jolts_of(of, body, probe, reading)); });
}

std::vector<ReadingValues> values_of_frames(const ReadingsCase& of, const std::vector<Reading>& readings)
{
    const MovedBody body(of);
    std::vector<std::unique_ptr<TimedReading>> timed;
    std::vector<TimedVariant> turns;
    for (const Reading& reading : readings) {
        timed.push_back(std::make_unique<TimedReading>(body, reading, of.scene.motion.time_step_s));
        turns.push_back([one = timed.back().get()] { return one->turn(); });
    }
    const auto seconds = take_turns(turns, {.seconds = of.timing_s});
    std::vector<ReadingValues> all;
    for (std::size_t i = 0; i < timed.size(); ++i) {
        const double ms = 1e3 * spread_of(seconds[i][0]).median;
        all.push_back({{of_frame(of.scene.character.body, int(body.character.mesh.rest.rows()), ms)}, !timed[i]->finite()});
    }
    return all;
}

RECORD_SETTINGS_AND(ReadingsCase,
                    .record("iterations", &ReadingsCase::most_iterations)
                        .constant("residual_tolerance", residual_tolerance)
                        .constant("satisfied_residual", satisfied_residual)
                        .constant("volume_tolerance_pct", volume_tolerance_pct)
                        .constant("jolt_k_stretch", {table_1_k_stretch, soft_k_stretch})
                        .constant("least_answer", least_answer),
                    scene, frame, pose, key, jolt_direction, jolt_steps, timing_s)

namespace {

void add_samples(std::vector<ArtefactSample>& samples, const ArtefactBody& body, const std::string& group, std::size_t pose,
                 const pbs::Positions& positions, int element_order)
{
    for (std::size_t joint = 0; joint < body.joints.size(); ++joint) {
        const JointProfile profile = body.sections[joint].measure(positions, body.posed.pose(pose));
        samples.push_back({group, pose, joint, extremes_of(profile), element_order});
    }
}

std::vector<ArtefactSample> reference_samples(const ArtefactCase& of, const ArtefactBody& body)
{
    std::vector<ArtefactSample> samples;
    if (of.claim != ArtefactCase::Claim::bulge) return samples;  // C04 does without it
    const Shapes shapes = body.posed.shapes(spec_of(of.scene, of.scene.reference));
    for (std::size_t pose = 0; pose < shapes.size(); ++pose)
        if (shapes[pose].finished) add_samples(samples, body, "reference", pose, shapes[pose].positions, 1);
    return samples;
}

}  // namespace

std::vector<ReadingValues> values_of_sections(const ArtefactCase& of, const std::vector<Reading>& readings)
{
    const ArtefactBody body(of);
    const std::vector<ArtefactSample> reference = reference_samples(of, body);
    std::vector<ReadingValues> all;
    for (const Reading& reading : readings) {
        const ReadMotion moved = move(body.posed.character(), of.scene, reading);
        std::vector<ArtefactSample> samples = reference;
        for (std::size_t pose = 0; pose < of.poses.size(); ++pose) {
            const pbs::Positions& shape = moved.shapes.at(static_cast<std::size_t>(of.poses[pose].frame));
            if (shape.allFinite()) add_samples(samples, body, "pbs", pose, shape, 0);
        }
        const bool bulge = of.claim == ArtefactCase::Claim::bulge;
        all.push_back({judged(bulge ? bulge_values(of, body, samples) : candy_wrapper_values(of, body, samples)), !moved.finite});
    }
    return all;
}

const analysis::Columns<VolumeChange> volume_change_columns = {
    {"scene", &VolumeChange::scene, "", "name of the scene"},
    {"place", &VolumeChange::place, "", "place of the paper that can be read in two ways"},
    {"reading_a", &VolumeChange::reading_a, "", "the baseline"},
    {"reading_b", &VolumeChange::reading_b, "", "the other reading"},
    {"quantity", &VolumeChange::quantity, "", "what is compared; its name ends with its unit"},
    {"a", &VolumeChange::a, "", "value by reading A"},
    {"b", &VolumeChange::b, "", "value by reading B"},
    {"change", &VolumeChange::change, "", "b less a"},
    {"verdict_changed", &VolumeChange::verdict_changed, "", "no, or the claims that are judged otherwise"}};

namespace {

const std::vector<std::string> volume_claims = {"C01", "C02"};

// Claims of the volume study whose extent on this scene differs, by metric.
std::string changed_verdicts(const ReadMotion& a, const ReadMotion& b)
{
    std::vector<std::string> changes;
    for (const analysis::Claim& claim : claims()) {
        if (claim.study != "volume") continue;
        const bool of_lbs = claim.deformer == "lbs";
        for (const std::string& metric : claim.metrics) {
            const analysis::Extent before = analysis::judge_case(claim, of_lbs ? a.lbs : a.pbs, metric).extent,
                                   after = analysis::judge_case(claim, of_lbs ? b.lbs : b.pbs, metric).extent;
            if (before != after)
                changes.push_back(fmt::format("{} by {}: {} -> {}", claim.id, metric, analysis::name_of(before), analysis::name_of(after)));
        }
    }
    return changes.empty() ? "no" : fmt::format("{}", fmt::join(changes, "; "));
}

double share_within(const std::vector<double>& change_pct)
{
    constexpr double printed_pct = 0.5;  // Sec. 4
    const auto holds = [](double change) { return std::abs(change) <= printed_pct; };
    return double(std::ranges::count_if(change_pct, holds)) / double(change_pct.size());
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

struct Baseline {
    Reading reading;
    ReadMotion moved;
};

void compare_volume(std::vector<ClaimChange>& changes, const std::string& body, const Reading& reading, const Baseline& a,
                    const ReadMotion& b)
{
    for (const std::string& claim : volume_claims)
        if (const std::string reason = untouched_because(claim, reading, a.reading); !reason.empty())
            changes.push_back(untouched_claim(body, claim, reading, reason));
        else
            std::ranges::copy(claim_changes(body, claim, reading, {judged(a.moved), !a.moved.finite}, {judged(b), !b.finite}),
                              std::back_inserter(changes));
}

}  // namespace

RECORD_SETTINGS(VolumeReadings, body, scene, readings)

std::vector<VolumeChange> volume_changes(const std::string& scene, const Reading& reading, const ReadMotion& a, const ReadMotion& b,
                                         const ReadMotion& resting, const std::vector<bool>& zone)
{
    using analysis::mean;
    const std::string verdict = changed_verdicts(a, b);
    std::vector<VolumeChange> rows;
    const auto add = [&](const std::string& quantity, double of_a, double of_b) {
        rows.push_back({scene, reading.place, reading.baseline, reading.name, quantity, of_a, of_b, of_b - of_a, verdict});
    };
    add(mean_change, mean(a.pbs.volume_change_pct), mean(b.pbs.volume_change_pct));
    add(mean_abs_change, mean(a.pbs.volume_abs_change_pct), mean(b.pbs.volume_abs_change_pct));
    add("mean_volume_change_of_lbs_pct", mean(a.lbs.volume_change_pct), mean(b.lbs.volume_change_pct));
    add(share_within_printed, share_within(a.pbs.volume_change_pct), share_within(b.pbs.volume_change_pct));
    add("mean_inverted_tets", mean(a.pbs.inverted_tets), mean(b.pbs.inverted_tets));
    for (std::size_t frame = 0; frame < a.pbs.angle_deg.size(); ++frame) {
        const double angle = a.pbs.angle_deg[frame];
        if (std::abs(angle - 90.0) >= 1e-6 && std::abs(angle - 170.0) >= 1e-6) continue;
        add(fmt::format("volume_change_at_{:.0f}_deg_pct", angle), a.pbs.volume_change_pct[frame], b.pbs.volume_change_pct[frame]);
        add(fmt::format("volume_abs_change_at_{:.0f}_deg_pct", angle), a.pbs.volume_abs_change_pct[frame],
            b.pbs.volume_abs_change_pct[frame]);
    }
    add(distance_from_a, 0.0, distance_m(a, b, {}));
    add(distance_by_jiggle, distance_m(a, resting, zone), distance_m(b, resting, zone));
    return rows;
}

std::string record_volume(const VolumeReadings& of, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(of.scene.character);
    const std::vector<bool> zone = pbs::jiggle_zone(character.binding);
    std::map<std::string, Baseline> baselines;
    std::vector<VolumeChange> volumes;
    std::vector<ClaimChange> changes;
    std::string breakdown;
    for (const Reading& reading : of.readings) {
        if (reading.options.jiggle && of.scene.motion.clip.empty()) {
            if (reading.place.empty()) continue;
            for (const std::string& claim : volume_claims)
                changes.push_back(untouched_claim(of.body, claim, reading, "a sweep has no speed of its own"));
            continue;
        }
        ReadMotion moved = move(character, of.scene, reading);
        if (!moved.finite) breakdown += reading.name + " is not finite. ";
        if (reading.place.empty()) {
            baselines.emplace(reading.name, Baseline{reading, std::move(moved)});
            continue;
        }
        const Baseline& baseline = baselines.at(reading.baseline);
        std::ranges::copy(volume_changes(of.scene.name, reading, baseline.moved, moved, baselines.at(own_reading).moved, zone),
                          std::back_inserter(volumes));
        compare_volume(changes, of.body, reading, baseline, moved);
    }
    table_of(volume_change_columns, volumes).write(analysis::path_in(folder, "figures.csv"));
    table_of(used_columns(claim_change_columns(), changes), changes).write(analysis::path_in(folder, "ambiguity.csv"));
    return breakdown;
}

std::string volume_markdown(const std::vector<VolumeChange>& changes)
{
    std::string text =
        "| scene | place | B | signed A -> B [%] | absolute A -> B [%] | within 0.5 % A -> B | distance of B from A [mm] | jiggle A -> B "
        "[mm] | verdict changed |\n|---|---|---|---|---|---|---|---|---|\n";
    for (const VolumeChange& first : changes) {
        if (first.quantity != mean_change) continue;
        const auto of = [&](const char* quantity) -> const VolumeChange& {
            return *std::ranges::find_if(changes, [&](const VolumeChange& other) {
                return other.quantity == quantity && other.scene == first.scene && other.place == first.place &&
                       other.reading_b == first.reading_b;
            });
        };
        text += fmt::format("| {} | {} | {} | {:.2f} -> {:.2f} | {:.2f} -> {:.2f} | {:.2f} -> {:.2f} | {:.3f} | {:.2f} -> {:.2f} | {} |\n",
                            first.scene, title_of_place(first.place), first.reading_b, first.a, first.b, of(mean_abs_change).a,
                            of(mean_abs_change).b, of(share_within_printed).a, of(share_within_printed).b, 1e3 * of(distance_from_a).b,
                            1e3 * of(distance_by_jiggle).a, 1e3 * of(distance_by_jiggle).b, first.verdict_changed);
    }
    return text;
}

}  // namespace experiments
