// From studies to records to verdicts: runs the studies that the named claims need, then computes the verdicts from the
// records on disk.
#pragma once

#include "analysis/records/record_files.hpp"
#include "experiments/studies/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct ReproduceArguments {
    std::vector<std::string> names;  // of claims or studies; empty: the default set of studies
    std::string folder = "results/reproduce";
    bool full = false, resume = false;
    bool plan_only = false;     // runs nothing and prints the runs to do as JSON
    bool records_only = false;  // with `only`: writes nothing but the records of the runs, so that several processes
                                // may work in one folder
    int jobs = 2;
    std::optional<std::string> external = {};  // a file with deformers of the user's own, for studies that compare them
    // names of runs; the others are kept if they are finished. Empty: all runs of the studies
    std::vector<std::string> only = {};
};

// Writes DIR/STUDY/RUN/... and what last_screen.hpp states, and prints the last screen. Returns the exit status: 1 if
// results differ from the kept record, a verdict could not be computed or a study's own bounds do not hold.
int reproduce(const ReproduceArguments& arguments);

// Runs nothing: computes the verdicts from the records that are in the folder, and writes claims.json and claims.md
// again.
int judge_again(const ReproduceArguments& arguments);

// The records that decide the claims of a study, read from disk alone. DIR/STUDY/plan.json lists the planned runs and
// the scenes that were left out; the folder of each run has metrics.csv, printed.csv or measurements.csv.
//   write_study_plan(folder, plan);
//   const analysis::Records records = read_study_records(folder, root);
void write_study_plan(const std::string& folder, const StudyPlan& plan);

// A folder of results as `pbskin reproduce` writes it: the folder itself, or the runs of kept records, which have one
// table per study and kind (experiments/records/keep.py), with a folder each. These are temporary and have what
// verdicts are computed from.
class OpenedRecords {
public:
    // Without `studies`, the runs of all are opened; otherwise only those of these studies.
    explicit OpenedRecords(const std::string& folder, const std::optional<std::vector<std::string>>& studies = {});
    const std::string& folder() const { return folder_; }

private:
    std::string folder_;
    std::optional<analysis::ScratchFolder> scratch_;
};

// A table of kept records, of which long ones are compressed: NAME.csv or NAME.csv.gz. InputError if it cannot be read
// or is damaged.
std::string kept_text(const std::string& file);

bool has_study_plan(const std::string& folder);

// The folders of the finished runs, in the order of the plan.
FinishedRuns finished_runs(const std::string& folder);

// root: the runs are named by their paths relative to this folder.
analysis::Records read_study_records(const std::string& folder, const std::string& root);

// The lines above the table of claims about frames of a study's runs that need attention: frames in which the reference
// intersects itself, the share that errors leave out, errors that are not above those of the reference, and frames that
// broke down, with the worst element of the first one.
//   fmt::print("{}", marked_frames(finished_runs(folder).folders));

// Reads run.json in the folders of finished runs. InputError if such a file is not one that this program wrote.
std::string marked_frames(const std::vector<std::string>& folders);

}  // namespace experiments
