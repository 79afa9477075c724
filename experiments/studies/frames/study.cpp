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
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/solver/options.hpp"

namespace experiments {
namespace {

// The column "jiggling" of Table 1 is k_stretch in the zone. Outside the zone k_stretch is 1.
void add_pbs(Scene& scene, const nlohmann::json& other)
{
    DeformerSpec spec = *find_deformer_with<pbs::PbsOptions>(scene);
    spec.label = other.at("label");
    spec.variant = other.at("variant");
    auto& options = options_of<pbs::PbsOptions>(spec);
    options.k_stretch = other.value("k_stretch", options.k_stretch);
    if (other.contains("k_in_zone")) options.jiggle = pbs::Jiggle{other.at("k_in_zone").get<double>()};
    if (other.contains("lbs_entry")) options.lbs_entry = option_of<pbs::LbsEntry>(other.at("lbs_entry").get<std::string>());
    scene.deformers.push_back(spec);
}

StudyPlan plan(bool full)
{
    return plan_of_cases("frames", full, [](const StudyCase& of, StudyPlan& plan) {
        StudyRun run{.name = of.name, .cost_s = of.cost_s};
        run.scene = of.scene({"output.frames=[]", "output.frame_names=[]", "output.frames_every=1"});
        run.scene.name = of.name;
        run.bad_frames_are_results = !run.scene.reference.empty();  // the sweeps go beyond the last pose that flesh reaches
        for (const nlohmann::json& other : of.value<nlohmann::json>("pbs", nlohmann::json::array())) add_pbs(run.scene, other);
        plan.runs.push_back(run);
    });
}

}  // namespace

Study frames_study()
{
    return {"frames", plan};
}

}  // namespace experiments
