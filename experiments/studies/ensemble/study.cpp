// Which deformer is closer to elastic flesh, whatever reference of a family is taken (ensemble/ensemble.hpp)?
//
//   limb_twist_90, limb_bend_60 (--full: also twist 150, bend 90)    o=======o~~~~~~~o
//   human_crouch                (--full: also three more poses)      CMU's clip 01_01
//
// Writes DIR/ensemble/CASE/{members,errors,pairs}.csv and pairs.csv, members.csv, ensemble.md.
#include "experiments/studies/ensemble/ensemble.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/ensemble/ensemble_page.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <tuple>

namespace experiments {
namespace {

std::string measure_and_record(const EnsembleCase& of, const std::string& folder)
{
    const EnsembleRecords records = measure_ensemble(of);
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    table_of(member_columns, records.members).write(path("members.csv"));
    table_of(error_columns, records.errors).write(path("errors.csv"));
    table_of(pair_columns, records.pairs).write(path("pairs.csv"));
    return records.breakdown;
}

EnsembleCase ensemble_case(const analysis::CaseKey& key, const Scene& scene, int frame)
{
    EnsembleCase of;
    of.of = key;
    of.scene = scene;
    of.frame = frame;
    of.members = family();
    of.flesh = reference_flesh(scene);
    for (const char* kind : {"lbs", "dqs", "delta_mush", "xpbd"}) of.deformers.push_back(default_spec(kind));
    DeformerSpec pbs = spec_of(scene, "pbs");
    options_of<pbs::PbsOptions>(pbs).jiggle.reset();
    of.deformers.push_back(pbs);
    DeformerSpec elastic = of.flesh;
    elastic.name = elastic.label = linear_elements;
    auto& small_strain = options_of<FemOptions>(elastic);
    small_strain.model = reference_fem::Model::linear;
    small_strain.most_newton_steps = 0;
    of.deformers.push_back(elastic);
    return of;
}

StudyRun limb_run(const std::string& motion, int angle_deg, double cost_s)
{
    const Scene scene = read_scene("limb_" + motion, {fmt::format("motion.angle_deg={}", angle_deg), "motion.frames=2"});
    const EnsembleCase of = ensemble_case({.body = "limb", .motion = motion, .angle_deg = angle_deg}, scene, 1);
    return work_run(case_name(of.of), of, cost_s, measure_and_record);
}

// pbs::InputError if the body is not installed.
StudyRun human_run(const std::string& pose, int frame, double cost_s)
{
    const Scene scene = read_scene("human_01_01", {});
    const EnsembleCase of = ensemble_case({.body = "human", .motion = "01_01", .pose = pose}, scene, frame);
    return work_run(case_name(of.of), of, cost_s, measure_and_record);
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(limb_run("twist", 90, 350.0));
    plan.runs.push_back(limb_run("bend", 60, 400.0));
    if (full) {
        plan.runs.push_back(limb_run("twist", 150, 450.0));
        plan.runs.push_back(limb_run("bend", 90, 5000.0));
    }
    try {
        plan.runs.push_back(human_run("crouch", clip_frames::crouch, 1200.0));
        if (full)
            for (const auto& [pose, frame, cost_s] : {std::tuple{"standing", clip_frames::standing, 3000.0},
                                                      {"in_the_air", clip_frames::in_the_air, 600.0},
                                                      {"landing", clip_frames::landing, 600.0}})
                plan.runs.push_back(human_run(pose, frame, cost_s));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"", false};
    const std::vector<PairRow> pairs = finished.rows(pair_columns, "pairs.csv");
    const std::vector<MemberRow> members = finished.rows(member_columns, "members.csv");
    finished.write("pairs.csv", pair_columns, pairs);
    finished.write("members.csv", member_columns, members);
    const std::string page = ensemble_page(pairs, members);
    finished.write("ensemble.md", page);
    return {page, true};
}

}  // namespace

Study ensemble_study()
{
    return {"ensemble", plan, when_named, conclude};
}

}  // namespace experiments
