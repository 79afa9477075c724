// The verbs of `pbskin`, one file each. A verb adds its options and what it does; what it returns is the exit status.
#pragma once

#include "experiments/process/exit_status.hpp"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace experiments {

// What all verbs share.
struct CommonOptions {
    bool quiet = false, verbose = false;
    int threads = 1;
};

using VerbAction = std::function<int()>;

// Each returns the subcommand's action through `action` when the subcommand was given.
void add_list_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_explain_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_run_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_reproduce_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_check_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_measure_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_mesh_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_bench_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_fetch_verb(CLI::App& app, CommonOptions& common, VerbAction& action);
void add_report_verb(CLI::App& app, CommonOptions& common, VerbAction& action);

// A subcommand with the options every verb has: --quiet, --verbose, --threads.
CLI::App* add_verb(CLI::App& app, CommonOptions& common, const std::string& name, const std::string& meaning);

}  // namespace experiments
