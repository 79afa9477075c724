// Compares two folders of results: a run of mine with the record, before and after a change, or two machines.
//   const ResultComparison compared = compare_results({.first = record, .second = here});
//   if (!compared.agrees()) fmt::print("{}", comparison_text(compared));
// Tables with the same name in runs with the same name are compared row by row (analysis/records/table_comparison.hpp).
// Tables of a study, which sum up its runs, are compared if they have a row per case.
#pragma once

#include "analysis/check/check.hpp"
#include "analysis/records/table_comparison.hpp"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct ComparedTable {
    std::string name;  // volume/limb_twist/metrics.csv, or metrics.csv of a single run
    analysis::TableComparison rows;
};

// The compared numbers of a claim: its values in the tables of measurements, or the frames by which it is judged.
struct ComparedClaim {
    int numbers = 0, differing = 0;
    int frames = 0, frames_differing = 0;
    bool agrees() const { return differing == 0 && frames_differing == 0; }
};

struct ComparedFolders {
    std::string first, second;    // folders of results: of `reproduce`, of one run, or kept records
    bool second_is_part = false;  // what only the first folder has is no difference
    std::optional<std::vector<std::string>> studies = {};  // that are compared; nothing: all
    // Bodies with other tets, whose runs are not compared. A verdict takes in all bodies, so that no verdict is
    // compared either.
    std::vector<std::string> excluded_bodies = {};
};

// The name of a run has its body between underscores: man_01_01, pbs_man, equal_quality_man_crouch.
bool is_run_of(const std::string& run, const std::string& body);

struct ResultComparison {
    ComparedFolders folders;
    std::vector<ComparedTable> tables = {};                      // that both have
    std::vector<std::string> only_first = {}, only_second = {};  // studies, runs, tables and rows
    // runs without a record, tables without rows, frames that are broken
    std::vector<std::string> not_compared = {};
    std::vector<std::string> other_settings = {};      // of a run: "pbs.k_stretch = 0.2 | 0.5"
    std::vector<std::string> other_verdicts = {};      // "C04: holds | fails"
    std::map<std::string, ComparedClaim> claims = {};  // by id

    int numbers() const;
    int equal() const;
    int differing() const;
    bool agrees() const;
};

// InputError if a folder has no results, or if the two have no number in common although all studies are compared.
ResultComparison compare_results(const ComparedFolders& folders);

// For the terminal: the answer first, then what differs, at most `lines` of each kind.
std::string comparison_text(const ResultComparison& compared, int lines = 12);

// Numbers: "94 agree", "2 of 94 differ"; frames: "115 frames agree".
std::string claim_text(const ComparedClaim& compared);

// "This machine repeats the record: 1,293 of 1,293 numbers agree (1,269 in every digit)."
std::string repeated_text(const ResultComparison& compared);

nlohmann::json to_json(const ResultComparison& compared);

// A suite per study and a case per table, for reports in JUnit's form.
std::vector<analysis::CheckSuite> suites_of(const ResultComparison& compared);

// The folder of the kept records, next to the program or at PBSKIN_RECORDS.
std::string records_folder();

}  // namespace experiments
