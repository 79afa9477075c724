// The volume study (claims C01, C02): how much volume each deformer loses, by pose.
//
//   limb_twist   0 - 180 deg    o=======o~~~~~~~o)  the forearm turns about its own axis
//   limb_bend    0 - 150 deg    o=======o           the forearm turns about z, also with Eq. 12-20 as printed
//   human_01_01  the whole clip                     MakeHuman's body, repeated jumps; LBS and PBS also at half and twice its vertices
//
// Beside the scene's own order of projection, PBS in each other order and precision: on the limb and on the human (the clip at five frames
// a second, with --full the whole of it), so that the report can say whether the verdict hangs on it.
//
// Each of the three with LBS, DQS, PBS at 1 to 96 iterations, on the clip PBS with the jiggling zone on, and linear FEM of order 1 and 2 on
// the same tets; the limb also with stable neo-Hookean flesh, the human with that of order 1 at
// five frames a second.
#include "experiments/deformers/option_names.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>

namespace experiments {
namespace {

constexpr int iteration_ladder[] = {1, 2, 4, 8, 12, 48, 96};  // beside the scene's own 24

DeformerSpec with_iterations(DeformerSpec spec, int iterations)
{
    spec.pbs.iterations = iterations;
    spec.label += "_" + std::to_string(iterations);
    return spec;
}

DeformerSpec pbs_of(const Scene& scene)
{
    return *std::find_if(scene.deformers.begin(), scene.deformers.end(), [](const auto& spec) { return spec.kind == "pbs"; });
}

StudyRun with_orders(StudyRun run)
{
    const DeformerSpec own = pbs_of(run.scene);
    for (const auto order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped})
        for (const auto precision : {pbs::Precision::f32, pbs::Precision::f64}) {
            if (order == own.pbs.order && precision == own.pbs.precision) continue;
            DeformerSpec spec = own;
            spec.name = "pbs_orders";
            spec.pbs.order = order;
            spec.pbs.precision = precision;
            spec.label += "_" + name_of(order) + "_" + name_of(precision);
            run.scene.deformers.push_back(spec);
        }
    return run;
}

DeformerSpec jiggling(DeformerSpec spec)
{
    spec.label += "_jiggle";
    spec.variant = "jiggle";
    spec.pbs.k_stretch = 1.0;            // where Table 1's "jiggling" stands for k_stretch in the zone, outside it is 1
    spec.pbs.jiggle = pbs::Jiggle{0.9};  // Table 1, Man
    return spec;
}

DeformerSpec in_print(DeformerSpec spec, pbs::VolumeForm form)
{
    spec.name = "pbs_printed";
    spec.pbs.volume_form = form;
    spec.pbs.order = pbs::Order::plain;
    spec.variant = name_of(form);
    spec.label += "_" + spec.variant;
    return spec;
}

StudyRun volume_run(const std::string& scene, const std::vector<std::string>& overrides, double cost_s)
{
    StudyRun run{scene, read_scene(scene, overrides), cost_s};
    std::vector<DeformerSpec>& deformers = run.scene.deformers;
    const DeformerSpec pbs = pbs_of(run.scene);
    for (const int iterations : iteration_ladder) deformers.push_back(with_iterations(pbs, iterations));
    if (!run.scene.motion.clip.empty()) deformers.push_back(jiggling(pbs));  // a sweep has no speed of its own
    return run;
}

StudyRun with_printed_forms(StudyRun run)
{
    const DeformerSpec pbs = pbs_of(run.scene);
    for (const auto form :
         {pbs::VolumeForm::labels_relative, pbs::VolumeForm::labels_absolute, pbs::VolumeForm::sign, pbs::VolumeForm::as_printed})
        run.scene.deformers.push_back(in_print(pbs, form));
    return run;
}

// Beside flesh that large rotations do not deceive, five frames a second.
StudyRun human_beside_truth(double cost_s)
{
    const std::string name = "human_01_01_truth";
    StudyRun run{.name = name,
                 .scene = read_scene("human_01_01", {"motion.rate_hz=5.0", "output.frames=[]", "output.frame_names=[]",
                                                     "deformers.use=[\"lbs\", \"dqs\", \"pbs\", \"snh_p1\"]", "reference.name=\"snh_p1\""}),
                 .cost_s = cost_s};
    run.scene.name = name;
    return run;
}

// What the size of the mesh does to the same figures: the blend and the paper's method alone, five frames a second.
StudyRun human_at(int vertices, double cost_s)
{
    const std::string name = "human_01_01_" + std::to_string(vertices);
    StudyRun run{name,
                 read_scene("human_01_01", {"character.vertices=" + std::to_string(vertices), "motion.rate_hz=5.0", "output.frames=[]",
                                            "output.frame_names=[]", "deformers.use=[\"lbs\", \"pbs\"]", "reference.name=\"\""}),
                 cost_s};
    run.scene.name = name;
    return run;
}

}  // namespace

StudyPlan plan_volume_study(bool full)
{
    const std::vector<std::string> quarter = {"motion.rate_hz=25.0", "output.frames=[0,41,168,177]"};  // four steps a frame
    StudyPlan plan;
    plan.runs.push_back(with_orders(volume_run("limb_twist", {}, 80.0)));
    plan.runs.push_back(with_orders(with_printed_forms(volume_run("limb_bend", {}, 40.0))));
    try {
        StudyRun human = volume_run("human_01_01", full ? std::vector<std::string>{} : quarter, full ? 720.0 : 180.0);
        plan.runs.push_back(full ? with_orders(human) : human);
        plan.runs.push_back(with_orders(human_beside_truth(150.0)));
        plan.runs.push_back(human_at(1200, 10.0));
        plan.runs.push_back(human_at(4800, 30.0));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human_01_01", error.what()});
    }
    return plan;
}

}  // namespace experiments
