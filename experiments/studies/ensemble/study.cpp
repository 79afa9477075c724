// Which deformer is closer to elastic flesh, whatever reference of a family is taken (ensemble/ensemble.hpp)?
//
//   limb_twist_90, limb_bend_60 (--full: also twist 150, bend 90)    o=======o~~~~~~~o
//   human_crouch                (--full: also three more poses)      CMU's clip 01_01
//
// Writes DIR/ensemble/CASE/{members,errors,pairs}.csv and pairs.csv, members.csv, ensemble.md.
#include "experiments/studies/ensemble/ensemble.hpp"

#include "analysis/records/folder_files.hpp"
#include "analysis/report_table.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

constexpr double notable_pct = 2.0;  // pairs that differ by more than this are to be decided
const std::string linear = "fem_linear";

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
    elastic.name = elastic.label = linear;
    auto& small_strain = options_of<FemOptions>(elastic);
    small_strain.model = reference_fem::Model::linear;
    small_strain.most_newton_steps = 0;
    of.deformers.push_back(elastic);
    return of;
}

StudyRun limb_run(const std::string& motion, int angle_deg, double cost_s)
{
    const Scene scene = read_scene("limb_" + motion, {fmt::format("motion.angle_deg={}", angle_deg), "motion.frames=2"});
    return work_run(fmt::format("limb_{}_{}", motion, angle_deg),
                    ensemble_case({.body = "limb", .motion = motion, .angle_deg = angle_deg}, scene, 1), cost_s, measure_and_record);
}

// pbs::InputError if the body is not installed.
StudyRun human_run(const std::string& pose, int frame, double cost_s)
{
    const Scene scene = read_scene("human_01_01", {});
    return work_run("human_" + pose, ensemble_case({.body = "human", .motion = "01_01", .pose = pose}, scene, frame), cost_s,
                    measure_and_record);
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(limb_run("twist", 90, 300.0));
    plan.runs.push_back(limb_run("bend", 60, 300.0));
    if (full) {
        plan.runs.push_back(limb_run("twist", 150, 350.0));
        plan.runs.push_back(limb_run("bend", 90, 900.0));
    }
    try {
        plan.runs.push_back(human_run("crouch", 164, 900.0));
        if (full)
            for (const auto& [pose, frame] : {std::pair{"standing", 0}, {"in_the_air", 672}, {"landing", 708}})
                plan.runs.push_back(human_run(pose, frame, 900.0));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

bool is_notable(const PairRow& pair)
{
    return pair.largest_difference_pct > notable_pct;
}

struct Count {
    std::ptrdiff_t decided = 0, notable = 0;
};
Count count_decided(const std::vector<PairRow>& pairs, auto&& is_counted)
{
    Count count;
    for (const PairRow& pair : pairs) {
        if (!is_notable(pair) || !is_counted(pair)) continue;
        ++count.notable;
        count.decided += pair.decision == analysis::PairDecision::decided;
    }
    return count;
}

std::string page_of(const std::vector<PairRow>& pairs, const std::vector<MemberRow>& members)
{
    const Count all = count_decided(pairs, [](const PairRow&) { return true; });
    const Count skinning = count_decided(pairs, [](const PairRow& pair) { return pair.first != linear && pair.second != linear; });
    std::vector<PairRow> undecided;
    for (const PairRow& pair : pairs)
        if (is_notable(pair) && pair.decision != analysis::PairDecision::decided) undecided.push_back(pair);
    const auto reached = std::ranges::count(members, std::string("reached"), &MemberRow::outcome);
    const auto without_bound = std::ranges::count_if(
        members, [](const MemberRow& member) { return member.outcome == "reached" && !member.error_bound_pct; });
    std::string page = fmt::format(
        "{} of {} references were reached. {} of these have no bound on their own error and decide nothing, because too few of their "
        "solutions converged without inverted tets.\n\n",
        reached, members.size(), without_bound);
    page += fmt::format(
        "{} of {} pairs of deformers whose errors differ by more than {:g} percentage points are decided. Without linear finite elements, "
        "these are {} of {} pairs.\n",
        all.decided, all.notable, notable_pct, skinning.decided, skinning.notable);
    if (!undecided.empty())
        page += "\n" + markdown_table(table_of(pair_columns, undecided), {{"body", "body"},
                                                                          {"motion", "motion"},
                                                                          {"pose", "pose"},
                                                                          {"angle [deg]", "angle_deg"},
                                                                          {"first", "first"},
                                                                          {"second", "second"},
                                                                          {"largest difference [%]", "largest_difference_pct", "{:.1f}"},
                                                                          {"first closer", "first_is_closer"},
                                                                          {"second closer", "second_is_closer"},
                                                                          {"decision", "decision"}});
    return page;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"", false};
    const std::vector<PairRow> pairs = finished.rows(pair_columns, "pairs.csv");
    const std::vector<MemberRow> members = finished.rows(member_columns, "members.csv");
    finished.write("pairs.csv", pair_columns, pairs);
    finished.write("members.csv", member_columns, members);
    const std::string page = page_of(pairs, members);
    finished.write("ensemble.md", page);
    return {page, true};
}

}  // namespace

Study ensemble_study()
{
    return {"ensemble", plan, when_named, conclude};
}

}  // namespace experiments
