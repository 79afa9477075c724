// A study: its runs, and the tables over their records. experiments/README.md describes how to add one.
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "analysis/verdicts/claims.hpp"
#include "experiments/scene/scene.hpp"

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace experiments {

// The finished runs of a study. A study reads their records and writes tables over all of them into its own folder.
struct FinishedRuns {
    std::string folder = {};                // of the study
    std::vector<std::string> folders = {};  // one per finished run, in the order of the plan
    std::vector<std::string> missing = {};  // names of the planned runs that did not finish

    bool none() const { return folders.empty(); }

    std::vector<std::string> files(const std::string& file) const;  // its path in every run that wrote it
    // The rows of `file` of all runs that wrote it. InputError as rows_of.
    template <typename Row>
    std::vector<Row> rows(const analysis::Columns<Row>& columns, const std::string& file) const
    {
        std::vector<Row> rows;
        for (const std::string& path : files(file))
            for (Row& row : rows_of(columns, analysis::read_csv(path))) rows.push_back(std::move(row));
        return rows;
    }

    // The same as a table of these columns. InputError for a run with others.
    analysis::CsvTable table(const std::vector<std::string>& columns, const std::string& file) const
    {
        analysis::CsvTable table(columns, file);
        for (const std::string& path : files(file)) table.append(analysis::read_csv(path));
        return table;
    }

    // Writes a record of the study. InputError if it cannot be written.
    void write(const std::string& file, const std::string& text) const;
    void write(const std::string& file, const analysis::CsvTable& table) const;
    template <typename Row>
    void write(const std::string& file, const analysis::Columns<Row>& columns, const std::vector<Row>& rows) const
    {
        write(file, table_of(columns, rows));
    }
};

// The work of a run, in a process of its own. It writes its records into `folder`, which exists and has no earlier
// run.json, and returns what broke down numerically, or "". An exception is a failure.
using StudyWork = std::function<std::string(const std::string& folder)>;

// Either a scene or, if `work` is given, a piece of work with its settings.
struct StudyRun {
    std::string name;  // of its folder in the folder of the study
    Scene scene = {};
    // of a scene whose motion is a sweep, e.g. twist; a clip and movements have names of their own
    std::string motion = {};
    double cost_s = 0.0;  // expected, on one core
    StudyWork work = {};
    bool beside = false;  // it decides nothing, for another run decides for its body and motion
    // For a scene that goes on until its reference breaks down: bad frames are recorded, listed below the claims, and
    // left out of claims that need their pose. In any other scene a bad frame is a breakdown.
    bool bad_frames_are_results = false;
    nlohmann::json settings = {};  // all that the result of the work depends on; recorded, and compared by --resume
};

// A run whose work depends only on a struct of settings, whose to_json records all its members.
template <typename Settings>
StudyRun work_run(const std::string& name, const Settings& settings, double cost_s,
                  std::string (*work)(const Settings& settings, const std::string& folder))
{
    StudyRun run{.name = name, .cost_s = cost_s};
    run.work = [settings, work](const std::string& folder) { return work(settings, folder); };
    run.settings = to_json(settings);
    return run;
}

using Overrides = std::vector<std::string>;  // KEY=VALUE of a scene

enum class Extent { none, quick, full };

struct StudyPlan {
    std::vector<StudyRun> runs;
    std::vector<analysis::LeftOut> left_out = {};  // scenes whose bodies are not installed
    Extent extent = Extent::quick;                 // as asked for
};

// A case of studies/NAME/cases.toml: data from which the study makes a run. The file is a list of such tables:
//   [[case]]
//   name = "{body}_walk"             # of the run; {body} in any text is the name of the case's body
//   bodies = ["human", "lady"]       # a case for each one that is installed; or body = "human"
//   scene = "human_01_01"            # and overrides = ["motion.duration_s=2.5"], as `pbskin run SCENE --set KEY=VALUE`
//   quick_s = 1.5                    # expected cost; a case without quick_s is no part of the default form, and one
//                                    # without full_s is no part of --full
//   full_s = 4.0
//   each = [{ name = "a" }, ...]     # a case for each entry, with these keys and those of the case
//   quick = { k_stretch = [0.1] }    # keys for one form, or for one of the bodies: fewer rows, each measured as in the
//                                    # full form. They replace the case's keys; only `overrides` are added to those of
//                                    # the case, as in `each`.
// The further keys are the study's own. A key that nothing reads is an error.
class StudyCase {
public:
    StudyCase(const std::string& study, const nlohmann::json& values, bool full);

    std::string name;
    double cost_s = 0.0;

    bool has(const std::string& key) const;
    template <typename T>
    T value(const std::string& key) const  // std::logic_error if the case lacks it
    {
        return at(key).get<T>();
    }
    template <typename T>
    T value(const std::string& key, const T& otherwise) const
    {
        return has(key) ? at(key).get<T>() : otherwise;
    }
    Scene scene(const Overrides& further_overrides = {}) const;  // of `scene` and `overrides`
    // PBS of that scene as a table states it: label, and where they differ name, variant and overrides.
    DeformerSpec further_pbs(const nlohmann::json& table, const Overrides& further_overrides = {}) const;
    // of that scene, with `motion`
    StudyRun scene_run(const std::string& run_name, const Overrides& further_overrides = {}) const;
    pbs::Vec3 direction(const std::string& key) const;  // of a jolt; upwards if the case does not state it
    analysis::CaseKey key() const;                      // body, motion, pose, angle_deg
    const nlohmann::json& values() const;               // all keys, which then count as read
    void require_nothing_unread() const;

private:
    const nlohmann::json& at(const std::string& key) const;

    std::string where_;
    nlohmann::json values_;
    mutable std::set<std::string> read_;
};

// The tables of studies/NAME/cases.toml: case, and what else the study states there.
nlohmann::json cases_document(const std::string& study);

// The plan of a study whose cases are data: `add` makes the run of each case of this form. A body that is not
// installed, or that `add` refuses by InputError, for example because a clip is missing, is left out with all of its
// further cases.
StudyPlan plan_of_cases(const std::string& study, bool full,
                        const std::function<void(const StudyCase& study_case, StudyPlan& plan)>& add);

// The extent in which `pbskin reproduce` and `pbskin reproduce --full`, both without names, run a study.
struct Sets {
    Extent quick = Extent::quick, full = Extent::full;
};
constexpr Sets quick_and_full = {Extent::quick, Extent::full};
// The whole study takes too long for --full, so that it runs only if it is named.
constexpr Sets in_short = {Extent::quick, Extent::quick};
constexpr Sets full_in_short = {Extent::none, Extent::quick};

struct Study {
    std::string
        name;  // of its folder, whose README.md is the page of `pbskin explain`, and of the folder of its records
    StudyPlan (*plan)(bool full) = nullptr;
    Sets sets = {};
    // Writes the tables over the finished runs, of which there is at least one, and returns whether the study holds,
    // apart from the verdicts on its claims. Null: there are none.
    bool (*conclude)(const FinishedRuns& finished) = nullptr;
    bool alone = false;  // it measures time: one run at a time, whatever -j is
    // The plan with deformers of the user's own from the [[external]] tables of a file. Null: the study has a fixed
    // list of deformers.
    StudyPlan (*plan_with)(bool full, const std::string& external_file) = nullptr;
    // Adds the runs of one case, as `plan` does for each of its own: the study `ambiguity` has cases of other studies.
    void (*add)(const StudyCase& study_case, StudyPlan& plan) = nullptr;
    // The values that follow from other measured values of a run: exponents, ranks, shares. A run records them, and
    // verdicts take what is concluded anew from the measured values on record. Null: every value is measured.
    std::vector<analysis::Measurement> (*conclusions)(const std::vector<analysis::Measurement>& measured) = nullptr;
};
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
Study references_study();
Study work_precision_study();
Study ensemble_study();
Study temporal_study();

// The claims of claims.toml, which is compiled into the program.
const std::vector<analysis::Claim>& claims();

// The page of a claim, which the halves of a sentence share: C02 for C02a and C02b.
std::string page_of(const analysis::Claim& claim);
bool is_asked_for(const analysis::Claim& claim, const std::string& name);  // by its id or its page

// std::logic_error for an id that claims.toml does not contain
const analysis::Claim& claim_named(const std::string& id);

// The paths at which two JSON objects differ: "pbs.k_volume". An object that only one of them has is one path.
std::vector<std::string> differing_paths(const nlohmann::json& a, const nlohmann::json& b);

}  // namespace experiments
