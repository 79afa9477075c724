// The studies that `pbskin reproduce` runs, and which of their runs it carries out.
//   for (const PlannedStudy& planned : plan_studies(arguments)) run(planned.to_do);
#pragma once

#include "experiments/studies/study.hpp"
#include "experiments/verdicts/reproduce.hpp"

#include <string>
#include <vector>

namespace experiments {

struct PlannedStudy {
    const Study* study;
    StudyPlan plan;
    std::string folder;
    std::vector<StudyRun> to_do = {};
    std::vector<StudyRun> kept = {};    // those that are finished with the same settings and revision
    std::vector<StudyRun> absent = {};  // those that ReproduceArguments::only leaves out and that are not finished
};

// InputError for a name that is neither a claim nor a study.
void refuse_unknown(const std::vector<std::string>& names);

// Returns whether the study or one of its claims is among these names.
bool is_named(const Study& study, const std::vector<std::string>& names);

// Returns the studies that have a run to do, or all studies without ReproduceArguments::only. Throws an InputError for the name of a run
// that no study has, for deformers of the user's own without a study that compares them, and where Study::plan_with does.
std::vector<PlannedStudy> plan_studies(const ReproduceArguments& arguments);

}  // namespace experiments
