// A study: its runs, and a conclusion from their records. experiments/README.md describes how to add one.
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace experiments {

// The work of a run, in a process of its own. It writes its records into `folder`, which exists and has no earlier run.json, and returns
// what broke down numerically, or "". An exception is a failure.
using StudyWork = std::function<std::string(const std::string& folder)>;

// Either a scene or, if `work` is given, a piece of work with its settings.
struct StudyRun {
    std::string name;  // of its folder in the folder of the study
    Scene scene = {};
    double cost_s = 0.0;  // expected, on one core
    StudyWork work = {};
    bool beside = false;  // it decides nothing, for another run decides for its body and motion
    // For a scene that goes on until its reference breaks down: bad frames are recorded, listed below the claims, and left out of claims
    // that need their pose. In any other scene a bad frame is a breakdown.
    bool bad_frames_are_results = false;
    nlohmann::json settings = {};  // all that the result of the work depends on; recorded, and compared by --resume
};

// A run whose work depends only on a case. The to_json of the case records all its members.
template <typename Case>
StudyRun work_run(const std::string& name, const Case& of, double cost_s, std::string (*work)(const Case& of, const std::string& folder))
{
    StudyRun run{.name = name, .cost_s = cost_s};
    run.work = [of, work](const std::string& folder) { return work(of, folder); };
    run.settings = to_json(of);
    return run;
}

enum class Extent { none, quick, full };

struct StudyPlan {
    std::vector<StudyRun> runs;
    std::vector<analysis::LeftOut> left_out = {};  // scenes whose bodies are not installed
    Extent extent = Extent::quick;                 // as asked for
};

// The result of a study in addition to the verdicts on its claims.
struct StudyConclusion {
    std::string text;  // for the terminal
    bool holds = true;
};

// The extent in which `pbskin reproduce` and `pbskin reproduce --full`, both without names, run a study.
struct Sets {
    Extent quick = Extent::quick, full = Extent::full;
};
constexpr Sets quick_and_full = {Extent::quick, Extent::full};
// The whole study takes too long for --full, so that it runs only if it is named.
constexpr Sets in_short = {Extent::quick, Extent::quick};
constexpr Sets full_in_short = {Extent::none, Extent::quick};
constexpr Sets when_named = {Extent::none, Extent::none};

struct Study {
    std::string name;  // of its folder, whose README.md is the page of `pbskin explain`, and of the folder of its records
    StudyPlan (*plan)(bool full) = nullptr;
    Sets sets = {};
    StudyConclusion (*conclude)(const FinishedRuns& finished) = nullptr;  // writes the summaries; null: there are none
    bool alone = false;                                                   // it measures time: one run at a time, whatever -j is
    // The plan with deformers of the user's own from the [[external]] tables of a file. Null: the study has a fixed list of deformers.
    StudyPlan (*plan_with)(bool full, const std::string& external_file) = nullptr;
};
const std::vector<Study>& studies();

// One per folder next to this file, each defined in its study.cpp.
Study volume_study();
Study audit_study();
Study momentum_study();
Study convergence_study();
Study stability_study();
Study artefacts_study();
Study jiggle_study();
Study stiffness_study();
Study setup_study();
Study ambiguity_study();
Study frames_study();
Study timing_study();
Study verification_study();
Study fit_study();
Study work_precision_study();
Study bench_study();
Study equal_quality_study();
Study features_study();
Study scale_study();
Study ensemble_study();

}  // namespace experiments
