#include "tests/architecture/laws.hpp"

#include <algorithm>

namespace architecture {
namespace {

constexpr int longest_file = 500, least_file = 60, longest_function = 120, usual_function = 60, longest_line = 140;
constexpr int several_users = 3;

const std::vector<std::string> cpp = {".cpp", ".hpp"}, scripts = {".py", ".js", ".mjs", ".css"};

// Files of fewer lines than `least_file` that are neither merged nor public headers with several users.
const std::map<std::string, std::string> named_interfaces = {
    {"experiments/studies/audit/printed_values.hpp", "what the tests ask of the study"},
    {"experiments/studies/timing/native_plain_module.cpp", "a module that the program loads"},
    {"experiments/studies/timing/plain_loops.hpp", "the interface of that module"},
    {"experiments/studies/verification/problem_list.cpp", "the entry of a module that the program loads"},
    {"experiments/trial/trial.hpp", "the interface of a library"},
    {"experiments/verdicts/check/check_run.hpp", "the interface of a library"},
    {"pbs/character/character_unavailable.cpp", "in place of a library that is left out"},
    {"pbs/flesh/cholmod_module.cpp", "a module that the program loads"},
    {"pbs/geometry/installed_eigen.hpp", "included by every file of another project"},
    {"pbs/geometry/mesh_io_unavailable.cpp", "in place of a library that is left out"},
    {"pbs/geometry/meshing_cgal.hpp", "the interface of CGAL's mesher, which one source compiles"},
    {"pbs/geometry/meshing_unavailable.cpp", "in place of a library that is left out"},
    {"pbs/geometry/nearest_rotation.cpp", "Eigen's form of formulae that the kernels use without Eigen"},
    {"pbs/rig/rig_reader_unavailable.cpp", "in place of a library that is left out"},
    {"pbs/solver/algorithm_1.hpp", "the solver in two precisions behind PbsSolver"},
    {"tests/properties/pbs/geometry/meshing_repeats.cpp", "one of two files that the mesher's library alone is linked with"},
    {"tests/unit/experiments/studies/shared/timed_rounds.cpp", "the tests of one source"},
    {"tests/unit/pbs/geometry/mesh_io_unavailable.cpp", "a program of its own"},
    {"tests/unit/pbs/geometry/meshing_unavailable.cpp", "a program of its own"},
    {"tests/verification/experiments/verification_record.cpp", "the problems that need a character, PBS or another program"},
};

// Rooms whose files are small for a reason.
const std::map<std::string, std::string> rooms_of_small_files = {
    {"pbs/constraints/", "one constraint a file, as the paper's equations"},
    {"tests/support/", "one fixture a header"},
    {"tests/fuzz/", "one target a file"},
    {"tests/packaging/", "projects of other people, as small as they would be"},
};

struct Function {
    int line, lines;
};

bool is_source(const std::string& path)
{
    return is_cpp(path) || is_cmake_file(path) || ends_with_any(path, {".py", ".sh"});
}

bool is_line_of_source(const std::string& path)
{
    return is_source(path) || is_command(path) || ends_with_any(path, {".js", ".mjs", ".css", "Snakefile"});
}

bool any_file(const std::string&)
{
    return true;
}

// The number of characters of UTF-8 text: bytes that do not continue a character.
int columns_of(const std::string& line)
{
    return static_cast<int>(std::ranges::count_if(line, [](char byte) { return (byte & 0xC0) != 0x80; }));
}

// In this format a function's braces are alone on their lines, with the indentation of its signature; so are those of loops and branches.
std::vector<Function> functions_of(const std::vector<std::string>& lines)
{
    static const std::regex control(R"(^\s*(for|if|else|while|switch|do|try|catch|struct|class|enum|union)\b)");
    std::vector<Function> functions;
    for (std::size_t open = 1; open < lines.size(); ++open) {
        const std::size_t indentation = lines[open].find('{');
        if (indentation == std::string::npos || lines[open].size() != indentation + 1 || lines[open].find_first_not_of(' ') != indentation)
            continue;
        if (std::regex_search(lines[open - 1], control)) continue;
        const std::string closing = std::string(indentation, ' ') + "}";
        std::size_t close = open;
        while (close + 1 < lines.size() && !lines[close].starts_with(closing)) ++close;
        functions.push_back({static_cast<int>(open), static_cast<int>(close - open) + 1});
        open = close;
    }
    return functions;
}

bool is_in_room_of_small_files(const std::string& path)
{
    return std::ranges::any_of(rooms_of_small_files, [&](const auto& room) { return path.starts_with(room.first); });
}

// Number of files that include a header, its own source excepted.
std::map<std::string, int> users_of_headers(const SourceTree& tree)
{
    std::map<std::string, int> users;
    for (const auto& [path, text] : tree)
        for (const Include& include : is_cpp(path) ? includes_of(text) : std::vector<Include>{})
            if (path.substr(0, path.rfind('.')) != include.target.substr(0, include.target.rfind('.'))) ++users[include.target];
    return users;
}

struct Total {
    int lines = 0, files = 0;
};

bool belongs_to(const Budget& budget, const std::string& path)
{
    return starts_with_any(path, budget.folders) && (budget.endings.empty() || ends_with_any(path, budget.endings));
}

// The lines and files of a budget, and of the folders and direct rooms that it names: "pbs/", "pbs/solver/".
std::map<std::string, Total> totals_of(const SourceTree& tree, const Budget& budget)
{
    std::map<std::string, Total> totals;
    for (const auto& [path, text] : tree) {
        if (!belongs_to(budget, path)) continue;
        std::vector<std::string> places = {budget.what};
        for (const std::string& folder : budget.folders) {
            if (!path.starts_with(folder)) continue;
            places.push_back(folder);
            if (const std::size_t end = path.find('/', folder.size()); end != std::string::npos) places.push_back(path.substr(0, end + 1));
        }
        const int lines = static_cast<int>(lines_of(text).size());
        for (const std::string& place : places) totals[place] = {totals[place].lines + lines, totals[place].files + 1};
    }
    return totals;
}

std::string exceeded(const std::string& what, int value, int most, const std::string& unit)
{
    return what + ": " + std::to_string(value) + " " + unit + ", at most " + std::to_string(most) + ": " + std::to_string(value - most) +
           " too many";
}

}  // namespace

// One line per budget: its folders, the kinds of its files, and its limits. A change that exceeds one names what it removes.
const std::vector<Budget>& budgets()
{
    static const std::vector<Budget> all = {
        {.what = "pbs", .folders = {"pbs/"}, .endings = cpp, .most_lines = 23'462, .least_mean = 120},
        {.what = "reference_fem", .folders = {"reference_fem/"}, .endings = cpp, .most_lines = 10'190, .least_mean = 120},
        {.what = "analysis", .folders = {"analysis/"}, .endings = cpp, .most_lines = 6'020, .least_mean = 120},
        {.what = "experiments", .folders = {"experiments/"}, .endings = cpp, .most_lines = 26'579, .least_mean = 120},
        {.what = "production C++",
         .folders = {"pbs/", "reference_fem/", "analysis/", "experiments/"},
         .endings = cpp,
         .most_lines = 66'200},
        {.what = "tests in C++", .folders = {"tests/"}, .endings = cpp, .most_lines = 44'240, .least_mean = 120},
        {.what = "tests in Python and JavaScript", .folders = {"tests/"}, .endings = scripts, .most_lines = 11'850},
        {.what = "paper_figures", .folders = {"paper_figures/"}, .endings = scripts, .most_lines = 8'533},
        {.what = "kept records", .folders = {"experiments/records/full/"}, .most_files = 150},
    };
    return all;
}

Violations file_sizes(const SourceTree& tree)
{
    Violations violations;
    for (const auto& [path, text] : tree)
        if (const int lines = static_cast<int>(lines_of(text).size()); is_source(path) && lines > longest_file)
            violations.push_back(at(path, 1, "file of " + std::to_string(lines) + " lines, at most " + std::to_string(longest_file)));
    return violations;
}

Violations folder_sizes(const SourceTree& tree, const std::vector<Budget>& budgets)
{
    Violations violations;
    for (const Budget& budget : budgets) {
        const std::map<std::string, Total> totals = totals_of(tree, budget);
        const auto whole = totals.find(budget.what);
        if (whole == totals.end()) continue;
        if (whole->second.lines > budget.most_lines)
            violations.push_back(exceeded(budget.what, whole->second.lines, budget.most_lines, "lines"));
        if (whole->second.files > budget.most_files)
            violations.push_back(exceeded(budget.what, whole->second.files, budget.most_files, "files"));
        for (const auto& [place, total] : totals)
            if (place != budget.what && !rooms_of_small_files.contains(place) && total.lines < budget.least_mean * total.files)
                violations.push_back(place + ": " + std::to_string(total.lines / total.files) + " lines per file in the mean, at least " +
                                     std::to_string(budget.least_mean) + ": merge the files of one topic");
    }
    return violations;
}

Violations small_files(const SourceTree& tree, const std::vector<Budget>& budgets)
{
    const std::map<std::string, int> users = users_of_headers(tree);
    Violations violations;
    for (const Budget& budget : budgets)
        for (const auto& [path, text] : tree) {
            const int lines = static_cast<int>(lines_of(text).size());
            const bool is_judged = budget.least_mean > 0 && belongs_to(budget, path) && lines < least_file;
            if (!is_judged || named_interfaces.contains(path) || is_in_room_of_small_files(path)) continue;
            const auto header = users.find(path);
            if (path.ends_with(".hpp") && header != users.end() && header->second >= several_users) continue;
            violations.push_back(at(path, 1,
                                    "file of " + std::to_string(lines) + " lines, at least " + std::to_string(least_file) +
                                        " unless it is a header with " + std::to_string(several_users) + " users"));
        }
    return violations;
}

Violations function_sizes(const SourceTree& tree)
{
    Violations violations, above_usual;
    std::size_t functions = 0;
    for (const auto& [path, text] : tree)
        for (const auto& [line, lines] : is_cpp(path) ? functions_of(lines_of(text)) : std::vector<Function>{}) {
            ++functions;
            const std::string what = at(path, line, "function of " + std::to_string(lines) + " lines");
            if (lines > longest_function) violations.push_back(what + ", at most " + std::to_string(longest_function));
            if (lines > usual_function) above_usual.push_back(what + ", and more than 1 in 10 have over " + std::to_string(usual_function));
        }
    if (10 * above_usual.size() > functions) violations.insert(violations.end(), above_usual.begin(), above_usual.end());
    return violations;
}

Violations line_lengths(const SourceTree& tree)
{
    return in_lines(tree, is_line_of_source, [](const std::string& line) {
        const int columns = columns_of(line);
        return columns > longest_line ? std::to_string(columns) + " columns, at most " + std::to_string(longest_line) : "";
    });
}

Violations absolute_paths(const SourceTree& tree)
{
    return in_lines(tree, any_file, std::regex(R"((^|[^\w.])/(home|root|work|Users)/\w)"), "a path of one machine");
}

Violations unfinished_marks(const SourceTree& tree)
{
    return in_lines(tree, any_file, std::regex(R"(\b(TO[D]O|FIX[M]E|XX[X]|HAC[K])\b)"), "finish it, or open an issue");
}

Violations stray_whitespace(const SourceTree& tree)
{
    return in_lines(tree, any_file, std::regex("\\t| $"), "a tab, or blanks at the end of the line");
}

}  // namespace architecture
