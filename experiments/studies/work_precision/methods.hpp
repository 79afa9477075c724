// The methods that are compared, as a table of names with KEY=VALUE overrides of a scene (cases.toml), and their
// settings.
//   for (const ComparedMethod& method : methods())
//       for (const Setting& setting : tried_settings(method, method.grid.front()))
//           spec_of(setting, scene, character, family().front());
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/posed_reference.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace experiments {

// Keys of a scene with their values, as for --set: "pbs.k_stretch=0.5".
using KeyValues = std::vector<std::string>;

struct ComparedMethod {
    std::string name = {};  // in the records
    std::string kind = {};  // of the deformer
    std::vector<std::string> takes = {};
    KeyValues overrides = {};
    std::vector<KeyValues> grid = {{}};  // tried with each number of iterations, the default first
    std::string iterations_key = {};
    std::vector<int> iterations = {};  // empty: it does not iterate
    std::vector<std::string> tables = {};
    bool k_by_edge_length = false;
    DeformerSpec external = {};  // of a deformer of the user's own, which has no kind above

    bool is_learned() const { return std::ranges::count(takes, "learned") > 0; }
    bool takes_flesh() const { return !takes.empty() && !is_learned(); }  // while it runs
    bool is_in(const std::string& table) const;
};
// Those whose deformers and keys this program has.
const std::vector<ComparedMethod>& methods();

// A method with the setting of another one and further overrides: another start, or flesh of a wrong material.
struct OtherStart {
    std::string name, of;
    KeyValues overrides;
};
const std::vector<OtherStart>& other_starts();

struct ComparisonTimes {
    std::vector<double> budgets_ms, tables_ms;
};
const ComparisonTimes& comparison_times();
std::vector<EnsembleMember> training_members();
std::vector<std::string> start_poses();

// One setting of a method: "vbd.iterations=12 vbd.omega=1.75".
struct Setting {
    const ComparedMethod* method = nullptr;
    KeyValues keys = {};

    std::string text() const;
};
// by increasing iterations
std::vector<Setting> tried_settings(const ComparedMethod& method, const KeyValues& of_grid);

// The deformer of a setting, on a scene that is built in, with the flesh of a member of the family. Members are those
// whose flesh a method takes; another method does not depend on them. InputError for a key that does not exist.
DeformerSpec spec_of(const Setting& setting, const Scene& scene, const pbs::Character& character,
                     const EnsembleMember& member);

// The setting of each method for each time, which the training poses have chosen (settings.csv, compiled into the
// program).
struct ChosenSetting {
    double budget_ms = 0.0;
    std::string method, setting;
    double training_ms = 0.0, training_error_pct = 0.0;  // mean time, and geometric mean of the error
};
extern const analysis::Columns<ChosenSetting> chosen_columns;  // settings.csv
const std::vector<ChosenSetting>& kept_settings();
KeyValues keys_in(const std::string& setting);

// Deformers of the user's own: the [[external]] tables of a file, which is written like a scene. Each is a method that
// takes nothing, with one setting. Throws an InputError for a file that cannot be read, has no such table or other
// tables, a name that a method or another start of the comparison has, a program that cannot be started, and a library
// that cannot be loaded. Paths are relative to the file.
std::vector<ComparedMethod> external_methods(const std::string& file);

// The length at which an edge has the stiffness k, so that the mean over all edges is k too: then the scaling softens
// long edges and stiffens short ones, and the mesh as a whole is neither softer nor stiffer. Bisection finds it to
// 1e-12 of the longest edge. It needs 0 < k < 1 and at least one edge.
double neutral_length(double k, const std::vector<double>& edge_lengths_m);

}  // namespace experiments
