// The verbs of `pbskin`, one file each. A verb adds its options and its action, which returns the exit status.
#pragma once

#include "experiments/process/failure.hpp"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace experiments {

// The options of all verbs.
struct CommonOptions {
    bool quiet = false, verbose = false;
    int threads = 1;
};

using VerbAction = std::function<int()>;

// Each sets `action` when the command line names its verb.
void add_list_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_explain_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_try_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_run_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_reproduce_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_check_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_measure_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_mesh_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_bench_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_fetch_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_report_verb(CLI::App& app, CommonOptions& common, VerbAction& action);

// Adds a subcommand with the options of all verbs: --quiet, --verbose, --threads.
CLI::App* add_verb(CLI::App& app, CommonOptions& common, const std::string& name, const std::string& meaning);

// The command line and the scene keys as JSON (`pbskin --describe`), from which the manual pages, the manual of scenes and the shells'
// completions are written. It has name, meaning, options, verbs with their options, and scene_keys. Hidden options are left out.
// An option has names (none: it is positional), name, meaning, value (empty: it is a flag), choices (empty: anything), repeated, required.
// A scene key has table, name, meaning, unit, rule, in_list and default (JSON text; empty: every scene must state it).
std::string describe(const CLI::App& app);

}  // namespace experiments
