// The verbs of `pbskin`. A verb adds its options and its action.
#pragma once

#include "experiments/process/terminal.hpp"

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace experiments {

// The options of all verbs.
struct CommonOptions {
    bool quiet = false, verbose = false;
    int threads = 1;
};

struct CommandLine {
    CLI::App& app;
    CommonOptions common = {};
    std::function<int()> action = {};  // of the verb that is named; it returns the exit status

    // A subcommand with the options of all verbs: --quiet, --verbose, --threads. The example ends its help.
    CLI::App* add(const std::string& verb, const std::string& meaning, const std::string& example,
                  const std::function<int()>& its_action);
};

using AddVerb = void(CommandLine& line);
AddVerb add_list_verb, add_explain_verb, add_try_verb, add_run_verb, add_reproduce_verb, add_check_verb,
    add_measure_verb, add_references_verb, add_compare_verb, add_mesh_verb, add_bench_verb, add_fetch_verb,
    add_report_verb;

void say_next(const std::string& words);  // what to do next, on stderr after all that was printed; --quiet hides it

// The command line and the scene keys as JSON (`pbskin --describe`), from which the manual pages, the manual of scenes
// and the shells' completions are written. It has name, meaning, options, verbs with their options, and scene_keys.
// Hidden options are left out. An option has names (none: it is positional), name, meaning, value (empty: it is a
// flag), choices (empty: anything), repeated, required. A scene key has table, name, meaning, unit, rule, in_list and
// default (JSON text; empty: every scene must state it).
std::string describe(const CLI::App& app);

// The files that a user means by frames: files, `frames_%04d.vtu`, `frames_*.vtu` (quoted), or a folder with one
// sequence.
//   for (const std::string& path : frame_files({"out/frames_%04d.vtu"})) ...
// The files in the order of their numbers, which may be negative and have a fraction. The number is the one in place of
// %d (%g, %f), or the one that differs between the names (frame_7_v2.vtu, frame_8_v2.vtu; time_0.5.vtu, time_1.vtu). A
// minus behind a letter is a hyphen (frame-7.vtu), unless other names lack it (t-1.vtu, t0.vtu). Files that are named
// one by one are taken as they are. InputError:
// - for a pattern or a folder that has no frames,
// - for names that differ in several numbers,
// - for a folder with several sequences,
// - for a number that is missing between the first and the last of a sequence, by its own smallest step: every fifth
//   frame is no gap, if there are three or more. A last step that is shorter than all others, which are equal, is a
//   warning.
struct FrameSearch {
    bool any_step = false;     // gaps are no error
    bool of_surfaces = false;  // in a folder the files of surfaces count, instead of those of tets
};
std::vector<std::string> frame_files(const std::vector<std::string>& arguments, const FrameSearch& search = {});

// The names of the frames in reports: the file's name, or its path as given if several files have that name.
std::vector<std::string> frame_names(const std::vector<std::string>& paths);

}  // namespace experiments
