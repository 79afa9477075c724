// C11: what the stiffness k in [0, 1] amounts to, as force over displacement of flesh that hangs under gravity, against iterations, time
// step and resolution. PBS, PBS with Mueller's exponent and XPBD run. XPBD has the stiffness of a material, and is the control.
//
//   bar   cantilever             limb, human, ...   the jiggling zone on what the solver moves, and with the rest of the body held
//
// On the limb XPBD also runs with its multipliers reset in every iteration: a control that has to fail, and no part of the claim. The claim
// is judged by the zone on what the solver moves, as the paper runs it; bars and zones on what is held are for comparison ("flesh held").
// Writes DIR/stiffness/{iterations,time_step,resolution}_BODY/stiffness.csv and measurements.csv; DIR/stiffness/stiffness.csv
// and exponents.csv.
#include "analysis/records/tables.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"
#include "experiments/studies/study.hpp"

#include <filesystem>

namespace experiments {
namespace {

StudyPlan plan(bool full)
{
    return plan_of_cases("stiffness", full, [](const StudyCase& of, StudyPlan& plan) {
        const StiffnessSweep sweep{option_of<Varied>(of.value<std::string>("varied")), of.value<std::string>("body"), of.full,
                                   of.value<std::vector<int>>("vertices", {0})};
        plan.runs.push_back(work_run(of.name, sweep, of.cost_s, record_stiffness));
    });
}

std::vector<StiffnessRow> rows_of_sweep(FinishedRuns finished, Varied varied)
{
    std::erase_if(finished.folders,
                  [&](const std::string& run) { return !std::filesystem::path(run).filename().string().starts_with(name_of(varied)); });
    return finished.rows(stiffness_columns, "stiffness.csv");
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::vector<SweptRows> swept;
    std::vector<StiffnessRow> all;
    std::vector<StiffnessExponent> exponents;
    for (const auto& [varied, name] : OptionNames<Varied>::table) {
        swept.emplace_back(varied, rows_of_sweep(finished, varied));
        std::ranges::copy(swept.back().second, std::back_inserter(all));
        std::ranges::copy(stiffness_exponents(swept.back().second, varied), std::back_inserter(exponents));
    }
    finished.write("stiffness.csv", stiffness_columns, all);
    finished.write("exponents.csv", used_columns(exponent_columns(), exponents), exponents);
    return {stiffness_text(swept) + control_text(swept, claim_named("C11")), !finished.none()};
}

}  // namespace

Study stiffness_study()
{
    return {"stiffness", plan, quick_and_full, conclude};
}

}  // namespace experiments
