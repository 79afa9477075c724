// The volume study (claims C01, C02): how much volume each deformer loses, by pose, and at which bones and joints.
//
//   limb_twist   0 - 180 deg    o=======o~~~~~~~o)  the forearm turns about its own axis
//   limb_bend    0 - 150 deg    o=======o           the forearm turns about z, also with Eq. 12-20 as printed
//   human_01_01  the whole clip                     MakeHuman's body, repeated jumps; LBS and PBS also at half and twice its vertices
//   human_01_03  ten seconds                        walking; with --full
//   man_01_01, lady_01_01, frankie_01_01            the first clip, bodies as large as those of Table 1, where installed
//   lady_01_03                                      walking, climbing, hanging from a bar, swinging
//
// Clips run at five frames per second, with --full at twenty-five. On the limb and the human, PBS runs with 1 to 384 iterations and linear
// FEM with elements of order 1 and 2 on the same tets; on all bodies PBS also has the jiggling zone. The reference is neo-Hookean flesh of
// order 1, and with --full of order 2 on the twisted limb. With --full the limb and, at one frame per second, the human also have flesh of
// order 2 with Poisson's ratios 0.45 and 0.49, and the other bodies have a reference at five frames per second. In addition to the scene's
// own order of projection PBS has each other order and precision, so that the report can say whether the verdict depends on it. Each run
// writes regions.csv; the study sums them up in regions.csv and regions.txt.
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/volume/region_table.hpp"

#include <algorithm>
#include <filesystem>

namespace experiments {
namespace {

constexpr int iteration_ladder[] = {1, 2, 4, 8, 12, 48, 96, 192, 384};  // in addition to the scene's own 24

DeformerSpec with_iterations(DeformerSpec spec, int iterations)
{
    options_of<pbs::PbsOptions>(spec).iterations = iterations;
    spec.label += "_" + std::to_string(iterations);
    return spec;
}

DeformerSpec pbs_of(const Scene& scene)
{
    return *find_deformer_with<pbs::PbsOptions>(scene);
}

StudyRun with_orders(StudyRun run)
{
    const DeformerSpec own = pbs_of(run.scene);
    const auto& own_options = options_of<pbs::PbsOptions>(own);
    for (const auto order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped})
        for (const auto precision : {pbs::Precision::f32, pbs::Precision::f64}) {
            if (order == own_options.order && precision == own_options.precision) continue;
            DeformerSpec spec = own;
            spec.name = "pbs_orders";
            options_of<pbs::PbsOptions>(spec).order = order;
            options_of<pbs::PbsOptions>(spec).precision = precision;
            spec.label += "_" + name_of(order) + "_" + name_of(precision);
            run.scene.deformers.push_back(spec);
        }
    return run;
}

DeformerSpec jiggling(DeformerSpec spec)
{
    spec.label += "_jiggle";
    spec.variant = "jiggle";
    auto& options = options_of<pbs::PbsOptions>(spec);
    options.k_stretch = 1.0;            // outside the zone, where Table 1's "jiggling" is k_stretch inside it
    options.jiggle = pbs::Jiggle{0.9};  // Table 1, Man
    return spec;
}

DeformerSpec in_print(DeformerSpec spec, pbs::VolumeForm form)
{
    spec.name = "pbs_printed";
    options_of<pbs::PbsOptions>(spec).volume_form = form;
    options_of<pbs::PbsOptions>(spec).order = pbs::Order::plain;
    spec.variant = name_of(form);
    spec.label += "_" + spec.variant;
    return spec;
}

// The sweeps end beyond the last pose that flesh on the body's own tets reaches, and some tets of the real bodies are inverted at rest.
StudyRun to_where_flesh_breaks(StudyRun run)
{
    run.bad_frames_are_results = true;
    return run;
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

// A scene under another name and with other settings. It writes no frames.
StudyRun run_named(const std::string& name, const std::string& scene, std::vector<std::string> overrides, double cost_s)
{
    overrides.insert(overrides.end(), {"output.frames=[]", "output.frame_names=[]"});
    StudyRun run{.name = name, .scene = read_scene(scene, overrides), .cost_s = cost_s};
    run.scene.name = name;
    return run;
}

// A run for comparison with another run of the same body and clip: it has another reference or another mesh.
StudyRun for_comparison(StudyRun run)
{
    run.beside = true;
    return run;
}

const std::string blends_and_pbs = R"(deformers.use=["lbs", "dqs", "pbs"])", no_reference = R"(reference.name="")";

const char* const without_quadratic_flesh = R"(deformers.use=["lbs", "dqs", "pbs", "fem_p1", "fem_p2", "fem_p1_embedded", "nh_p1"])";
const char* const all_references =
    R"(deformers.use=["lbs", "dqs", "pbs", "fem_p1", "fem_p2", "fem_p1_embedded", "nh_p1", "nh_p2", "nh_p2_nu_049"])";
// The twisted limb without its most expensive references, those of quadratic elements.
const std::vector<std::string> with_linear_reference = {without_quadratic_flesh, R"(reference.name="nh_p1")"};

// Quadratic elements, also for nearly incompressible flesh. The bend ends before the crease in which they take minutes per frame.
StudyRun bend_with_quadratic_reference(double cost_s)
{
    return run_named("limb_bend_quadratic", "limb_bend",
                     {"motion.angle_deg=60.0", "motion.frames=13",
                      R"(deformers.use=["lbs", "dqs", "pbs", "nh_p1", "nh_p2", "nh_p2_nu_049"])", R"(reference.name="nh_p2")"},
                     cost_s);
}

StudyRun human_with_quadratic_reference(double cost_s)
{
    return run_named(
        "human_01_01_quadratic", "human_01_01",
        {"motion.rate_hz=1.0", R"(deformers.use=["lbs", "dqs", "pbs", "nh_p1", "nh_p2", "nh_p2_nu_049"])", R"(reference.name="nh_p2")"},
        cost_s);
}

StudyRun human_walk(double cost_s)
{
    return run_named(
        "human_01_03", "human_01_01",
        {"motion.clip=01_03.bvh", "motion.rate_hz=25.0", "motion.duration_s=10.0", R"(deformers.use=["lbs", "dqs", "pbs", "nh_p1"])"},
        cost_s);
}

// The effect of the mesh's size on the same values: LBS and PBS only, at five frames per second.
StudyRun human_at(int vertices, double cost_s)
{
    const std::string size = std::to_string(vertices);
    return run_named("human_01_01_" + size, "human_01_01",
                     {"character.vertices=" + size, "motion.rate_hz=5.0", R"(deformers.use=["lbs", "pbs"])", no_reference}, cost_s);
}

void add_human(StudyPlan& plan, bool full)
{
    std::vector<std::string> overrides = {"motion.rate_hz=25.0", "output.frames=[0,41,168,177]"};  // four steps per frame
    if (!full) overrides = {"motion.rate_hz=5.0", "output.frames=[0,8,34,35]"};
    overrides.push_back(without_quadratic_flesh);
    const StudyRun human = with_orders(volume_run("human_01_01", overrides, full ? 400.0 : 60.0));
    plan.runs.push_back(to_where_flesh_breaks(human));
    if (full) {
        plan.runs.push_back(to_where_flesh_breaks(with_orders(human_walk(150.0))));
        plan.runs.push_back(to_where_flesh_breaks(for_comparison(human_with_quadratic_reference(600.0))));
    }
    plan.runs.push_back(for_comparison(human_at(1200, 0.5)));
    plan.runs.push_back(for_comparison(human_at(4800, 1.0)));
}

// Man, Lady or Frankie.
void add_fetched(StudyPlan& plan, const std::string& body, bool full)
{
    const std::string rate = full ? "motion.rate_hz=25.0" : "motion.rate_hz=5.0", scene = body + "_01_01";
    StudyRun own = run_named(scene, scene, {rate, blends_and_pbs, no_reference}, full ? 10.0 : 2.6);
    own.scene.deformers.push_back(jiggling(pbs_of(own.scene)));
    plan.runs.push_back(with_orders(own));
    if (full)
        plan.runs.push_back(
            to_where_flesh_breaks(for_comparison(run_named(scene + "_reference", scene, {}, body == "frankie" ? 95.0 : 20.0))));
    if (body == "lady")
        plan.runs.push_back(with_orders(
            run_named("lady_01_03", "lady_walk", {"motion.duration_s=0.0", rate, blends_and_pbs, no_reference}, full ? 16.0 : 4.0)));
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    const std::vector<std::string> twist = full ? std::vector<std::string>{all_references} : with_linear_reference;
    plan.runs.push_back(to_where_flesh_breaks(with_orders(volume_run("limb_twist", twist, full ? 72.0 : 9.0))));
    plan.runs.push_back(to_where_flesh_breaks(with_orders(with_printed_forms(volume_run("limb_bend", {without_quadratic_flesh}, 32.0)))));
    if (full) plan.runs.push_back(to_where_flesh_breaks(for_comparison(bend_with_quadratic_reference(60.0))));
    for_each_installed_body(plan.left_out, [&](const std::string& body) {
        if (body == "human")
            add_human(plan, full);
        else
            add_fetched(plan, body, full);
    });
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::vector<RunRegions> runs;
    for (const std::string& file : finished.files("regions.csv"))
        runs.push_back({std::filesystem::path(file).parent_path().filename().string(), rows_of(region_columns, analysis::read_csv(file))});
    const std::string text = region_text(runs);
    finished.write("regions.csv", region_csv(runs));
    finished.write("regions.txt", text);
    return {text, !finished.none()};
}

}  // namespace

Study volume_study()
{
    return {"volume", plan, quick_and_full, conclude};
}

}  // namespace experiments
