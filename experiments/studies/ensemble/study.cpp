// Which deformer is closer to elastic flesh, whatever reference of a family is taken, and is the error of PBS that of its solver, of its
// model or of the reference's discretisation (ensemble/ensemble.hpp)?
//
//   limb_twist_90, limb_bend_60 (--full: also twist 150, bend 90)    o=======o~~~~~~~o
//   --full: human crouch, standing, in the air, landing              CMU's clip 01_01
//
//   pbskin reproduce ensemble            20 minutes on one core
//   pbskin reproduce ensemble --full     four hours
//
// Writes DIR/ensemble/CASE/{members,errors,pairs,parts,attachments}.csv and, over all cases, pairs.csv, members.csv.
#include "experiments/studies/ensemble/ensemble.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"

namespace experiments {
namespace {

std::string measure_and_record(const EnsembleCase& of, const std::string& folder)
{
    const EnsembleRecords records = measure_ensemble(of);
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    table_of(member_columns, records.members).write(path("members.csv"));
    table_of(error_columns, records.errors).write(path("errors.csv"));
    table_of(pair_columns, records.pairs).write(path("pairs.csv"));
    table_of(part_columns, records.parts).write(path("parts.csv"));
    table_of(attachment_columns, records.attachments).write(path("attachments.csv"));
    return records.breakdown;
}

StudyPlan plan(bool full)
{
    return plan_of_cases("ensemble", full, [full](const StudyCase& in_file, StudyPlan& plan) {
        EnsembleCase of{.of = in_file.key(), .scene = in_file.scene(), .frame = in_file.value<int>("frame")};
        of.members = family();
        of.flesh = reference_flesh(of.scene);
        of.pbs = spec_of(of.scene, "pbs");
        options_of<pbs::PbsOptions>(of.pbs).jiggle.reset();
        DeformerSpec elastic = of.flesh;
        elastic.name = elastic.label = "fem_linear";
        auto& small_strain = options_of<FemOptions>(elastic);
        small_strain.model = reference_fem::Model::linear;
        small_strain.most_newton_steps = 0;
        for (const char* kind : {"lbs", "dqs", "delta_mush", "xpbd"}) of.deformers.push_back(default_spec(kind));
        of.deformers.insert(of.deformers.end(), {of.pbs, elastic});
        of.other_flesh = other_attachments(of.flesh);
        of.k_stretch = {0.05, 0.2, 0.9};
        of.iterations = {1, 4, 24, 96, 384};
        of.converged_iterations = full ? 32000 : 8000;
        plan.runs.push_back(work_run(in_file.name, of, in_file.cost_s, measure_and_record));
    });
}

// For the terminal: the pairs, and the parts after the paper's 24 iterations.
StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"", false};
    const std::vector<PairRow> pairs = finished.rows(pair_columns, "pairs.csv");
    finished.write("pairs.csv", pair_columns, pairs);
    finished.write("members.csv", member_columns, finished.rows(member_columns, "members.csv"));
    std::vector<PartsRow> parts = finished.rows(part_columns, "parts.csv");
    std::erase_if(parts, [](const PartsRow& row) { return row.iterations != 24; });
    const std::string of_pairs =
        text_table(table_of(pair_columns, pairs), analysis::report_columns("body motion pose angle_deg first second "
                                                                           "largest_difference_pct:.1f first_is_closer second_is_closer "
                                                                           "members decision"));
    const std::string of_parts =
        text_table(table_of(part_columns, parts), analysis::report_columns("body motion pose angle_deg k_stretch error_joint_pct:.1f "
                                                                           "solver_pct:.1f model_pct:.1f discretisation_pct:.2f"));
    return {of_pairs + "\n" + of_parts, true};
}

}  // namespace

Study ensemble_study()
{
    return {"ensemble", plan, full_in_short, conclude};
}

}  // namespace experiments
