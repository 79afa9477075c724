// Jiggle: does flesh in the paper's jiggling zone swing and come to rest by itself (C09a), by an amount that k_stretch
// alone sets (C09b)? README.md describes the runs and records.
//
// The limb is moved along its bones, the only direction in which the bind constraints leave all of its skin free;
// bodies are moved up. Flesh has no gravity, so that it lies still before the jolt. An arm that stops is compared with
// finite elements of the same material.
#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/options.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

double largest(std::vector<double>::const_iterator first, std::vector<double>::const_iterator last)
{
    double most = 0.0;
    for (; first != last; ++first) most = std::max(most, std::abs(*first));
    return most;
}

double ratio(double a, double b)
{
    return b > 0.0 ? a / b : 0.0;
}

void sum_up(JoltResponse& response, const Jolt& jolt)
{
    const auto& excursion = response.excursion_m;
    const auto& speed = response.speed_rms_m_s;
    if (excursion.empty()) return;
    const auto tenth = static_cast<std::ptrdiff_t>(excursion.size() / 10);
    const double peak = largest(excursion.begin(), excursion.end());
    response.path_m = jolt.length_m;
    response.peak_over_jolt = peak / jolt.length_m;
    response.overshoot_over_jolt = std::max(*std::max_element(excursion.begin(), excursion.end()), 0.0) / jolt.length_m;
    const auto beyond = [&](double excursion_m) { return std::abs(excursion_m) > settled_share * peak; };
    const auto last = std::find_if(excursion.rbegin(), excursion.rend(), beyond);
    response.settling_s = jolt.time_step_s * static_cast<double>(excursion.rend() - last);
    response.left_over_peak = ratio(largest(excursion.end() - tenth, excursion.end()), peak);
    response.speed_growth =
        ratio(largest(speed.begin() + tenth, speed.end()), largest(speed.begin(), speed.begin() + tenth));
    response.swing = analysis::fit_damped_oscillation(excursion, jolt.time_step_s);
}

bool advances(Deformer& deformer, const pbs::Pose& pose, double time_step_s)
{
    return deformer.advance(pose, time_step_s).outcome == pbs::Outcome::finished;
}

// Holds a pose and measures how far the probe lies from its place [m] along the jolt.
void swing(Deformer& deformer, const pbs::Pose& pose, const pbs::Positions& place, const std::vector<int>& probe,
           const Jolt& jolt, JoltResponse& response)
{
    const Eigen::Index vertices = place.rows();
    for (int step = 0; step < jolt.steps && response.finished; ++step) {
        const pbs::Positions before = deformer.positions().topRows(vertices);
        response.finished = advances(deformer, pose, jolt.time_step_s);
        const pbs::Positions now = deformer.positions().topRows(vertices);
        double excursion_m = 0.0;
        for (const int v : probe) excursion_m += (now.row(v) - place.row(v)).dot(jolt.direction);
        response.excursion_m.push_back(excursion_m / static_cast<double>(probe.size()));
        response.speed_rms_m_s.push_back((now - before).norm() / std::sqrt(double(vertices)) / jolt.time_step_s);
    }
}

DeformerSpec without_inertia(DeformerSpec spec)
{
    if (options_if<pbs::PbsOptions>(spec)) options_of<pbs::PbsOptions>(spec).jiggle.reset();
    if (options_if<pbs::XpbdOptions>(spec)) options_of<pbs::XpbdOptions>(spec).jiggle = false;
    if (options_if<FemOptions>(spec)) options_of<FemOptions>(spec).dynamics = reference_fem::Dynamics::quasi_static;
    return spec;
}

// A body that is not installed is refused before anything runs.
JoltCase jolt_case(const StudyCase& study_case)
{
    JoltCase jolt{.scene = study_case.value<std::string>("scene"),
                  .overrides = study_case.value<Overrides>("overrides"),
                  .settings = study_case.value<std::vector<Overrides>>("settings"),
                  .jolt = {.direction = study_case.direction("along")},
                  .with_reference = study_case.value("with_reference", false),
                  .young_pa = study_case.value<std::vector<double>>("young_pa", {})};
    for (const Overrides& setting : jolt.settings) scene_of(jolt, setting);
    return jolt;
}

void add_case(const StudyCase& study_case, StudyPlan& plan)
{
    if (study_case.has("stops"))
        plan.runs.push_back(work_run<StopCase>(study_case.name,
                                               {study_case.scene(), study_case.value<std::string>("stops")},
                                               study_case.cost_s, record_stop));
    else
        plan.runs.push_back(work_run(study_case.name, jolt_case(study_case), study_case.cost_s, record_jolts));
}

StudyPlan plan(bool full)
{
    return plan_of_cases("jiggle", full, add_case);
}

}  // namespace

JoltResponse jolt_response(const pbs::Character& character, const DeformerSpec& spec, const std::vector<int>& probe,
                           const Jolt& jolt)
{
    const std::unique_ptr<Deformer> deformer = make_deformer(spec);
    deformer->reset(character);
    const std::size_t bones = character.skeleton.bones.size();
    const pbs::Vec3 way_m = jolt.length_m * jolt.direction;
    const pbs::Pose still(bones, Eigen::Isometry3d::Identity()),
        moved(bones, Eigen::Isometry3d(Eigen::Translation3d(way_m)));
    JoltResponse response;
    for (int step = 0; step < jolt.still_steps && response.finished; ++step)
        response.finished = advances(*deformer, still, jolt.time_step_s);
    const pbs::Positions lay = deformer->positions().topRows(character.mesh.rest.rows());
    swing(*deformer, moved, lay.rowwise() + way_m.transpose(), probe, jolt, response);
    sum_up(response, jolt);
    return response;
}

JoltResponse stop_response(const pbs::Character& character, const DeformerSpec& spec, const std::vector<int>& probe,
                           const pbs::Motion& motion, int still_steps)
{
    const auto on_bones = [&](const pbs::Pose& pose) {
        pbs::Vec3 sum = pbs::Vec3::Zero();
        for (const int v : probe) sum += pose[character.binding.bone[v]] * character.mesh.rest.row(v).transpose();
        return pbs::Vec3(sum / static_cast<double>(probe.size()));
    };
    Jolt stop{.length_m = 0.0, .time_step_s = motion.time_step_s, .steps = still_steps};
    for (std::size_t step = 1; step < motion.steps.size(); ++step) {
        const pbs::Vec3 moved_m = on_bones(motion.steps[step]) - on_bones(motion.steps[step - 1]);
        stop.length_m += moved_m.norm();
        stop.direction = moved_m.normalized();
    }
    if (!(stop.length_m > 0.0))
        throw pbs::InputError("stop", 0, "motion", "", "expected a motion that moves the probe");
    const std::unique_ptr<Deformer> deformer = make_deformer(spec), at_rest = make_deformer(without_inertia(spec));
    deformer->reset(character);
    at_rest->reset(character);
    JoltResponse response{.finished = advances(*at_rest, motion.steps.back(), motion.time_step_s)};
    for (std::size_t step = 0; step < motion.steps.size() && response.finished; ++step)
        response.finished = advances(*deformer, motion.steps[step], motion.time_step_s);
    const pbs::Positions place = at_rest->positions().topRows(character.mesh.rest.rows());
    swing(*deformer, motion.steps.back(), place, probe, stop, response);
    if (!response.finished) return response;
    std::vector<double>& excursion = response.excursion_m;
    const auto tenth = static_cast<std::ptrdiff_t>(excursion.size() / 10);
    const double rest_m = analysis::mean({excursion.end() - tenth, excursion.end()});
    for (double& excursion_m : excursion) excursion_m -= rest_m;
    response.rest_over_jolt = rest_m / stop.length_m;
    sum_up(response, stop);
    return response;
}

Study jiggle_study()
{
    return {"jiggle", plan, quick_and_full, nullptr, false, nullptr, add_case, jiggle_conclusions};
}

}  // namespace experiments
