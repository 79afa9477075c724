#include "experiments/studies/ambiguity/reading_values.hpp"

#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/momentum/momentum_drift.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "pbs/character/overlap_and_jiggle.hpp"

#include <fmt/format.h>

#include <algorithm>
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
    paths.body = of.scene.character.body;
    paths.pose = of.pose;
    paths.key = of.key;
    paths.vertices = static_cast<int>(character.mesh.rest.rows());
    paths.tets = static_cast<int>(character.mesh.tets.rows());
    paths.setting = {reading.options.order, reading.options.precision};
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
        result.all.front().k_stretch = readings.front().options.k_stretch;  // names the case, alike for all readings
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

nlohmann::json to_json(const ReadingsCase& of)
{
    static const auto fields = OptionFields<ReadingsCase>("readings")
                                   .record("scene", &ReadingsCase::scene)
                                   .record("frame", &ReadingsCase::frame)
                                   .record("pose", &ReadingsCase::pose)
                                   .record("key", &ReadingsCase::key)
                                   .record("jolt_direction", &ReadingsCase::jolt_direction)
                                   .record("iterations", &ReadingsCase::most_iterations)
                                   .record("jolt_steps", &ReadingsCase::jolt_steps)
                                   .record("timing_s", &ReadingsCase::timing_s)
                                   .constant("residual_tolerance", residual_tolerance)
                                   .constant("satisfied_residual", satisfied_residual)
                                   .constant("volume_tolerance_pct", volume_tolerance_pct)
                                   .constant("jolt_k_stretch", {table_1_k_stretch, soft_k_stretch})
                                   .constant("least_answer", least_answer)
                                   .complete();
    return fields.json(of);
}

}  // namespace experiments
