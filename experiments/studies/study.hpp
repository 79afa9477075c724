// A study: runs and what is told of their records. A new one is one file and one line in studies.cpp.
#pragma once

#include "analysis/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/finished_runs.hpp"

#include <functional>
#include <string>
#include <vector>

namespace experiments {

// Writes its records into `folder`, which is there and holds no earlier run.json, and says what broke down numerically, if anything; an
// exception is its failure. It runs in a process of its own.
using StudyWork = std::function<std::string(const std::string& folder)>;

// Either a scene or, where `work` is given, a piece of work with its settings.
struct StudyRun {
    std::string name;  // its folder inside the study's
    Scene scene = {};
    double cost_s = 0.0;  // expected, on one core
    StudyWork work = {};
    bool beside = false;  // of a body and motion that another run is judged by
    // Of a scene that goes as far as its reference breaks: frames that it does not reach, or inverts, are on record, told below the claims
    // and left out where they show another pose. Any other scene is expected to finish, each frame sound: one that is not is a breakdown.
    bool bad_frames_are_results = false;
    nlohmann::json settings = {};  // what the work is the result of: on record, and what --resume compares
};

// A run whose work depends on a case and on nothing else. All members of the case are recorded, by its to_json.
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
    std::vector<analysis::LeftOut> left_out = {};  // what is not installed here
    Extent extent = Extent::quick;                 // as it was asked for
};

// What a study says when its runs have ended, beside the claims that are judged from their records.
struct StudyConclusion {
    std::string text;  // for the terminal
    bool holds = true;
};

// How much of a study is part of `pbskin reproduce` and of `pbskin reproduce --full`, both without names.
struct Sets {
    Extent quick = Extent::quick, full = Extent::full;
};
constexpr Sets quick_and_full = {Extent::quick, Extent::full};
// The whole study would take longer than --full may: it runs when it is named.
constexpr Sets in_short = {Extent::quick, Extent::quick};
constexpr Sets full_in_short = {Extent::none, Extent::quick};
constexpr Sets when_named = {Extent::none, Extent::none};

struct Study {
    std::string name;  // of its folder, whose README.md is its page in `pbskin explain`, and of its records' folder
    StudyPlan (*plan)(bool full) = nullptr;
    Sets sets = {};
    StudyConclusion (*conclude)(const FinishedRuns& finished) = nullptr;  // writes the records that sum up the runs
    bool alone = false;  // it times: one run at once, whatever -j says
};
const std::vector<Study>& studies();

// One per folder beside this file, each defined in its study.cpp.
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
Study error_split_study();
Study bench_study();
Study features_study();
Study scale_study();

}  // namespace experiments
