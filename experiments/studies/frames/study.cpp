// The frames that figures and the report's viewer show. No claim is judged by them.
//
//   limb_twist   0 - 180 deg by 10    o=======o~~~~~~~o)   LBS, DQS, PBS and neo-Hookean finite elements on the same tets
//   limb_bend    0 - 110 deg by 10    o=======o            (--full: to 150, where the finite elements take longest)
//   limb_bend_rigid                                        LBS and PBS with rigid weights in place of Eq. 2
//   human_jump   1.6 s of 01_01 from 6.0 s on, 25 frames per second: the four; PBS with increments of LBS, and with the jiggling zone
//   human_walk   the first 2.4 s of 01_03: the four; PBS with the jiggling zone, and with the same stiffness without a zone
//
// Writes DIR/frames/RUN/frames/*.vtu and .vtp, and in DIR/frames/RUN metrics.csv, bones.csv, bones_rest.csv, binding.csv,
// surface_rest.vtp and embedding.csv.
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/options.hpp"

#include <fmt/format.h>

namespace experiments {
namespace {

const std::string the_four = R"(deformers.use=["lbs","dqs","pbs","nh_p1"])", blend_and_pbs = R"(deformers.use=["lbs","pbs"])";

StudyRun shown(const std::string& name, const std::string& scene, std::vector<std::string> overrides, double cost_s)
{
    overrides.insert(overrides.end(), {"output.frames=[]", "output.frame_names=[]", "output.frames_every=1"});
    StudyRun run{.name = name, .scene = read_scene(scene, overrides), .cost_s = cost_s};
    run.scene.name = name;
    run.bad_frames_are_results = !run.scene.reference.empty();  // the sweeps go beyond the last pose that flesh reaches
    return run;
}

StudyRun with_pbs(StudyRun run, const std::string& label, const std::string& variant, auto&& change)
{
    DeformerSpec spec = *find_deformer_with<pbs::PbsOptions>(run.scene);
    spec.label = label;
    spec.variant = variant;
    change(options_of<pbs::PbsOptions>(spec));
    run.scene.deformers.push_back(spec);
    return run;
}

// The column "jiggling" of Table 1 is k_stretch in the zone. Outside the zone k_stretch is 1.
const double k_stretch_with_jiggle = 1.0;

StudyRun with_jiggle(StudyRun run, double k_jiggle)
{
    return with_pbs(std::move(run), "pbs_jiggle", "jiggle", [&](pbs::PbsOptions& options) {
        options.k_stretch = k_stretch_with_jiggle;
        options.jiggle = pbs::Jiggle{k_jiggle};
    });
}

// The baseline for jiggling: the same stiffness without a zone.
StudyRun without_jiggle(StudyRun run)
{
    return with_pbs(std::move(run), "pbs_no_zone", "no_zone", [](pbs::PbsOptions& options) { options.k_stretch = k_stretch_with_jiggle; });
}

StudyRun without_the_start_from_lbs(StudyRun run)
{
    return with_pbs(std::move(run), "pbs_increment", "increment",
                    [](pbs::PbsOptions& options) { options.lbs_entry = pbs::LbsEntry::increment; });
}

void add_limb(StudyPlan& plan, bool full)
{
    const int steps = full ? 15 : 11;
    const std::string angle = fmt::format("motion.angle_deg={}", 10 * steps), frames = fmt::format("motion.frames={}", steps + 1);
    const std::string reference = R"(reference.name="nh_p1")", none = R"(reference.name="")";
    plan.runs.push_back(shown("limb_twist", "limb_twist", {the_four, reference, "motion.frames=19"}, 3.5));
    plan.runs.push_back(shown("limb_bend", "limb_bend", {the_four, reference, angle, frames}, full ? 17.0 : 5.0));
    plan.runs.push_back(shown("limb_bend_rigid", "limb_bend", {blend_and_pbs, none, angle, frames, R"(skinning.weights="rigid")"}, 0.5));
}

void add_human(StudyPlan& plan)
{
    const std::string reference = R"(reference.name="nh_p1")", rate = "motion.rate_hz=25.0";
    const StudyRun jumping =
        shown("human_jump", "human_01_01", {the_four, reference, rate, "motion.start_s=6.0", "motion.duration_s=1.6"}, 16.0);
    plan.runs.push_back(with_jiggle(without_the_start_from_lbs(jumping), 0.9));
    const StudyRun walking =
        shown("human_walk", "human_01_01", {the_four, reference, rate, "motion.clip=01_03.bvh", "motion.duration_s=2.4"}, 21.0);
    plan.runs.push_back(with_jiggle(without_jiggle(walking), 0.1));
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    add_limb(plan, full);
    try {
        add_human(plan);
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

}  // namespace

Study frames_study()
{
    return {"frames", plan};
}

}  // namespace experiments
