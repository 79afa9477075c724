// Jiggle (C09): does flesh in the paper's jiggling zone swing and come to rest by itself, at a pace that k_stretch alone sets?
//
//   BODY_jolt        the skeleton is moved by 2 cm in one step and held: frequency, damping and amplitude of the zone's largest piece
//                    against k_stretch, time step, iterations and masses; what the zone is on this body
//   limb_reference   a small limb's jolt beside finite elements in time (generalised alpha) that swing as fast
//   BODY_walk        two and a half seconds of CMU's clip 01_03, then held still for one: how far the flesh lags, and whether it rests
//
// The limb is moved along its bones, which is the one way in which the bind constraints leave all of its skin free; bodies are moved up.
// Jolted flesh has no weight, that it may lie still before; what walks has.
// Writes DIR/jiggle/RUN/{responses,series,zone,measurements}.csv or walk.csv, and jiggle.md.
#include "analysis/records/atomic_file.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/jiggle/jiggle_report.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <filesystem>

namespace experiments {
namespace {

void plan_limb(bool full, StudyPlan& plan)
{
    const Jolt along_the_bones{.direction = pbs::Vec3::UnitX()};
    const Scene limb = read_scene("limb_twist", {});
    plan.runs.push_back(work_run<JoltCase>("limb_jolt", {limb, along_the_bones, jiggle_settings()}, 2.5, record_jolts));
    const Scene small = read_scene("limb_twist", {"character.vertices=400"});
    std::vector<JiggleSetting> beside = {JiggleSetting{}};
    if (full) beside = {{.k_stretch = 0.05}, {}, {.k_stretch = 0.2}, {.iterations = 6}};
    plan.runs.push_back(work_run<JoltCase>("limb_reference", {small, along_the_bones, beside, true}, full ? 10.0 : 4.0, record_jolts));
}

void plan_body(const std::string& body, bool full, StudyPlan& plan)
{
    std::vector<std::string> overrides = {"character.body=" + body, "motion.clip=01_03.bvh", "motion.duration_s=2.5",
                                          "deformers.use=[\"lbs\",\"pbs\"]", "reference.name=\"\""};
    const Scene walking = read_scene("human_01_01", overrides);
    overrides.push_back("pbs.gravity_m_s2=[0.0,0.0,0.0]");
    plan.runs.push_back(
        work_run<JoltCase>(body + "_jolt", {read_scene("human_01_01", overrides), {}, jiggle_settings()}, 3.0, record_jolts));
    const std::vector<double> k = full ? std::vector<double>{0.05, 0.1, 0.2, 0.5, 0.7, 0.9} : std::vector<double>{0.1, 0.7};
    plan.runs.push_back(work_run<WalkCase>(body + "_walk", {walking, k}, full ? 4.0 : 1.5, record_walk));
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan_limb(full, plan);
    for (const std::string& body : installed_bodies(plan.left_out)) {
        try {
            plan_body(body, full, plan);
        } catch (const pbs::InputError& error) {
            plan.left_out.push_back({body, error.what()});
        }
    }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::string text;
    for (const std::string& run : finished.folders) text += jiggle_report(run);
    finished.write("jiggle.md", text);
    return {text, !finished.none()};
}

}  // namespace

Study jiggle_study()
{
    return {"jiggle", plan, quick_and_full, conclude};
}

}  // namespace experiments
