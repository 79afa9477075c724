// A study: runs and what is told of their records. A new one is one file and one line in studies.cpp.
#pragma once

#include "analysis/case_record.hpp"
#include "experiments/scene/scene.hpp"

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

struct Study {
    std::string name;  // of its folder, whose README.md is its page in `pbskin explain`, and of its records' folder
    StudyPlan (*plan)(bool full) = nullptr;
    Sets sets = {};
    // Of the study's folder and the folders of the runs that ended; writes the records that sum them up.
    StudyConclusion (*conclude)(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished) = nullptr;
    bool alone = false;  // it times: one run at once, whatever -j says
};
const std::vector<Study>& studies();

StudyPlan plan_volume_study(bool full);
StudyConclusion conclude_volume_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_audit_study(bool full);
StudyConclusion conclude_audit_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_fit_study(bool full);
StudyConclusion conclude_fit_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_artefacts_study(bool full);
StudyConclusion conclude_artefacts_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_jiggle_study(bool full);
StudyConclusion conclude_jiggle_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_momentum_study(bool full);
StudyPlan plan_ambiguity_study(bool full);
StudyConclusion conclude_ambiguity_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_convergence_study(bool full);
StudyConclusion conclude_convergence_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_work_precision_study(bool full);
StudyConclusion conclude_work_precision_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_stability_study(bool full);
StudyConclusion conclude_stability_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_stiffness_study(bool full);
StudyConclusion conclude_stiffness_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_timing_study(bool full);
StudyConclusion conclude_timing_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_error_split_study(bool full);
StudyConclusion conclude_error_split_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_setup_study(bool full);
StudyConclusion conclude_setup_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_bench_study(bool full);
StudyConclusion conclude_bench_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_frames_study(bool full);
StudyPlan plan_features_study(bool full);
StudyConclusion conclude_features_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_scale_study(bool full);
StudyConclusion conclude_scale_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);
StudyPlan plan_verification_study(bool full);
StudyConclusion conclude_verification_study(const std::string& folder, const StudyPlan& plan, const std::vector<std::string>& finished);

}  // namespace experiments
