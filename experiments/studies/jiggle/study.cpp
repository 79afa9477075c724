// Jiggle (C09): does flesh in the paper's jiggling zone swing and come to rest by itself, at a rate that k_stretch alone sets?
//
//   BODY_jolt        the skeleton is moved by 2 cm in one step and held: frequency, damping and amplitude of the zone's largest piece
//                    against k_stretch, time step, iterations and masses; what the zone is on this body
//   limb_reference   the jolt of a small limb, compared with finite elements in time (generalised alpha) that swing as fast
//   BODY_walk        two and a half seconds of CMU's clip 01_03, then held still for one: how far the flesh lags, and whether it rests
//
// The limb is moved along its bones, the only direction in which the bind constraints leave all of its skin free; bodies are moved up.
// Flesh has no gravity in a jolt, so that it lies still before it, and has gravity in a walk.
// Writes DIR/jiggle/RUN/{responses,series,zone,measurements}.csv or walk.csv.
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

JoltCase jolt_case(const StudyCase& of)
{
    JoltCase jolt{of.scene(), {}, jiggle_settings(), of.value("with_reference", false)};
    jolt.jolt.direction = of.direction("along");
    if (!of.has("settings")) return jolt;
    jolt.settings.clear();
    for (const nlohmann::json& differs : of.value<nlohmann::json>("settings"))
        jolt.settings.push_back({.k_stretch = differs.value("k_stretch", JiggleSetting{}.k_stretch),
                                 .iterations = differs.value("iterations", JiggleSetting{}.iterations)});
    return jolt;
}

StudyPlan plan(bool full)
{
    return plan_of_cases("jiggle", full, [](const StudyCase& of, StudyPlan& plan) {
        if (of.value<std::string>("measure") == "jolt")
            plan.runs.push_back(work_run(of.name, jolt_case(of), of.cost_s, record_jolts));
        else
            plan.runs.push_back(
                work_run<WalkCase>(of.name, {of.scene(), of.value<std::vector<double>>("k_stretch")}, of.cost_s, record_walk));
    });
}

// C09 of readings: a jolt without gravity at the reading's own stiffness in the zone, at 0.1 there, at half the time step and at twice the
// iterations. A reading whose flesh does not jiggle takes Table 1's 0.9 in the zone. All count as the paper's own setting.
constexpr double table_1_k_stretch = 0.9, soft_k_stretch = 0.1;
constexpr double least_answer = 1e-3;  // of the jolt; flesh that LBS carries along moves by rounding, some 1e-5, which is no swing

// named: the setting under which the values are recorded, which is the paper's, whatever the reading makes of it.
MeasuredJiggle jolted(const pbs::Character& character, const std::vector<int>& probe, const Jolt& jolt, const DeformerSpec& read,
                      const JiggleSetting& named, double k_stretch)
{
    DeformerSpec spec = read;
    auto& options = options_of<pbs::PbsOptions>(spec);
    const bool everywhere = options.jiggle && options.k_stretch == options.jiggle->k_stretch;
    if (!options.jiggle) options.jiggle = pbs::Jiggle{};
    options.jiggle->k_stretch = k_stretch;
    if (everywhere) options.k_stretch = k_stretch;
    options.iterations = named.iterations;
    options.gravity_m_s2.setZero();
    MeasuredJiggle measured{named, jolt_response(character, spec, probe, jolt)};
    if (measured.response.peak_over_jolt < least_answer) measured.response.swing = {};
    return measured;
}

std::vector<MeasuredJiggle> jolts_of(const StudyCase& of, const pbs::Character& character, const std::vector<int>& probe,
                                     const Overrides& reading)
{
    const Scene scene = of.scene(reading);
    const DeformerSpec spec = spec_of(scene, "pbs");
    const auto& options = options_of<pbs::PbsOptions>(spec);
    const double dt_s = of.scene().motion.time_step_s, k = options.jiggle ? options.jiggle->k_stretch : table_1_k_stretch;
    const int substeps = static_cast<int>(std::lround(dt_s / scene.motion.time_step_s));
    const auto jolt = [&](const JiggleSetting& named, double k_stretch) {
        Jolt of_setting{.direction = of.direction("along"), .time_step_s = named.time_step_s / substeps};
        of_setting.still_steps *= substeps;
        of_setting.steps = substeps * of.value<int>("jolt_steps");
        return jolted(character, probe, of_setting, spec, named, k_stretch);
    };
    return {jolt({table_1_k_stretch, dt_s, options.iterations}, k), jolt({soft_k_stretch, dt_s, options.iterations}, soft_k_stretch),
            jolt({table_1_k_stretch, 0.5 * dt_s, options.iterations}, k), jolt({table_1_k_stretch, dt_s, 2 * options.iterations}, k)};
}

// Only the quantities that one setting gives or two of them do. The others need all settings of the study.
std::vector<ReadingValues> read_jolts(const StudyCase& of, const std::vector<Overrides>& readings)
{
    const std::vector<std::string> of_few_settings = {"damping_ratio", "frequency_ratio_at_half_time_step",
                                                      "frequency_ratio_at_twice_iterations"};
    const pbs::Character character = pbs::make_character(of.scene().character);
    const std::vector<int> probe = zone_contents(character).pieces.at(0);
    const auto settings = std::ranges::count_if(jiggle_settings(), is_of_the_paper);
    std::vector<ReadingValues> all;
    for (const Overrides& reading : readings) {
        const std::vector<MeasuredJiggle> measured = jolts_of(of, character, probe, reading);
        ReadingValues read{jiggle_values(character.name, measured)};
        read.broke_down = !std::ranges::all_of(measured, [](const MeasuredJiggle& one) { return one.response.finished; });
        read.left_out =
            all_but("C09", of_few_settings,
                    fmt::format("the bound is for the study's {} settings, a reading is jolted at {}", settings, measured.size()));
        std::erase_if(read.values, [&](const analysis::Measurement& value) {
            return std::ranges::count(read.left_out, value.quantity, &ReadingValues::LeftOut::quantity) > 0;
        });
        all.push_back(read);
    }
    return all;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::string text;
    for (const std::string& file : finished.files("responses.csv"))
        text +=
            std::filesystem::path(file).parent_path().filename().string() + "\n" +
            text_table(analysis::read_csv(file), analysis::report_columns("deformer k_stretch time_step_ms:.3g iterations masses k_bind "
                                                                          "outcome frequency_hz:.2f damping_ratio:.3f")) +
            "\n";
    return {text, !finished.none()};
}

}  // namespace

Study jiggle_study()
{
    return {"jiggle", plan, quick_and_full, conclude, false, nullptr, read_jolts};
}

}  // namespace experiments
