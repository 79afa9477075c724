#include "experiments/command_line/verbs.hpp"

#include "analysis/records/record_files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <regex>
#include <set>
#include <tuple>

namespace experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_number = 15;  // digits; what is longer is taken for text

bool is_digit(unsigned char c)
{
    return std::isdigit(c) != 0;
}

std::string name_of(const std::string& path)
{
    return fs::path(path).filename().string();
}

// Files that differ in one number: each is `before`, its number, `after`.
struct Sequence {
    std::string before, after;
    std::size_t width = longest_number;           // of its shortest number
    std::map<long long, std::string> files = {};  // by number

    void add(const std::string& digits, const std::string& path)
    {
        width = std::min(width, digits.size());
        const auto [earlier, is_new] = files.emplace(std::stoll(digits), path);
        if (!is_new) throw pbs::InputError(path, 0, "frame", digits, "the same number as " + earlier->second);
    }
};

struct FoundFrames {
    std::vector<std::string> without_number;
    std::vector<Sequence> sequences;
};

// A name cut at its numbers: text, number, text, ..., text.
std::vector<std::string> cut_at_numbers(const std::string& name)
{
    std::vector<std::string> pieces = {""};
    for (auto at = name.begin(); at != name.end();) {
        const auto number = std::find_if(at, name.end(), is_digit), end = std::find_if_not(number, name.end(), is_digit);
        pieces.back().append(at, number);
        if (static_cast<std::size_t>(end - number) > longest_number)
            pieces.back().append(number, end);
        else if (number != end)
            pieces.insert(pieces.end(), {std::string(number, end), ""});
        at = end;
    }
    return pieces;
}

// The sequence of files of one form, as frame_0007_v2.vtu and frame_0008_v2.vtu. The number that differs counts; in a single name, the
// last.
Sequence sequence_of(const std::string& argument, const std::vector<std::string>& paths)
{
    std::vector<std::vector<std::string>> names;
    for (const std::string& path : paths) names.push_back(cut_at_numbers(name_of(path)));
    const std::vector<std::string>& first = names.front();
    std::set<std::size_t> differing;
    for (const auto& name : names)
        for (std::size_t i = 1; i < name.size(); i += 2)
            if (name[i] != first[i]) differing.insert(i);
    if (differing.size() > 1)
        throw pbs::InputError(
            argument, 0, "", "",
            fmt::format("expected frames that differ in one number, found {} and {}; name one sequence, as in 'NAME_%04d.vtu'",
                        paths.front(), paths.back()));
    const std::size_t at = differing.empty() ? first.size() - 2 : *differing.begin();
    const std::string before = std::accumulate(first.begin(), first.begin() + at, std::string());
    Sequence sequence{(fs::path(paths.front()).parent_path() / before).string(),
                      std::accumulate(first.begin() + at + 1, first.end(), std::string())};
    for (std::size_t i = 0; i < paths.size(); ++i) sequence.add(names[i][at], paths[i]);
    return sequence;
}

FoundFrames sequences_in(const std::string& argument, const std::vector<std::string>& paths)
{
    std::map<std::vector<std::string>, std::vector<std::string>> forms;  // folder and texts of a name -> paths
    for (const std::string& path : paths) {
        const std::vector<std::string> pieces = cut_at_numbers(name_of(path));
        std::vector<std::string> form = {fs::path(path).parent_path().string()};
        for (std::size_t i = 0; i < pieces.size(); i += 2) form.push_back(pieces[i]);
        forms[form].push_back(path);
    }
    FoundFrames found;
    for (const auto& [form, alike] : forms)
        if (form.size() == 2)  // the folder and one text
            found.without_number.insert(found.without_number.end(), alike.begin(), alike.end());
        else
            found.sequences.push_back(sequence_of(argument, alike));
    return found;
}

// Two files alone show no step: between frames 1 and 3, frame 2 is missing.
void require_no_gap(const Sequence& sequence)
{
    const auto& files = sequence.files;
    long long step = files.size() < 3 ? 1 : std::numeric_limits<long long>::max();
    for (auto file = files.begin(); std::next(file) != files.end(); ++file) step = std::min(step, std::next(file)->first - file->first);
    for (auto file = files.begin(); std::next(file) != files.end(); ++file) {
        const long long wanted = file->first + step;
        if (std::next(file)->first != wanted)
            throw pbs::InputError(
                fmt::format("{}{:0{}}{}", sequence.before, wanted, sequence.width, sequence.after), 0, "frame", std::to_string(wanted),
                fmt::format("missing: the sequence goes from {} to {} by {}", files.begin()->first, files.rbegin()->first, step));
    }
}

// Those without a number first, then one sequence after the other.
std::vector<std::string> in_order(FoundFrames found)
{
    const auto place = [](const Sequence& sequence) { return std::tie(sequence.before, sequence.after); };
    std::sort(found.sequences.begin(), found.sequences.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
    std::vector<std::string> files = std::move(found.without_number);
    for (const Sequence& sequence : found.sequences) {
        require_no_gap(sequence);
        for (const auto& [number, path] : sequence.files) files.push_back(path);
    }
    return files;
}

void require_one_sequence(const std::string& folder, const FoundFrames& found)
{
    std::vector<std::string> names;
    for (const Sequence& sequence : found.sequences) names.push_back(sequence.files.begin()->second);
    if (names.empty()) return;
    names.insert(names.end(), found.without_number.begin(), found.without_number.end());
    if (names.size() > 1)
        throw pbs::InputError(
            folder, 0, "", "",
            fmt::format("expected one sequence of frames, found those of {}; name one, as in 'NAME_%04d.vtu'", fmt::join(names, ", ")));
}

bool is_mesh(const fs::path& file)
{
    static const std::set<std::string> endings = {".vtu", ".vtk", ".msh", ".mesh", ".ele"};
    return endings.contains(file.extension().string());
}

std::vector<std::string> in_folder(const std::string& folder)
{
    std::vector<std::string> files;
    std::error_code gone;
    for (const fs::path& file : analysis::files_in(folder))
        if (fs::is_regular_file(file, gone) && is_mesh(file)) files.push_back(file.string());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::string> globbed(const std::string& pattern)
{
    glob_t found = {};
    std::vector<std::string> files;
    if (glob(pattern.c_str(), 0, nullptr, &found) == 0) files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    globfree(&found);
    return files;
}

// frames_%04d.vtu as C's printf writes it: the files whose number is written just so.
std::optional<Sequence> of_number_pattern(const std::string& pattern)
{
    static const std::regex form("(.*)%(0?)([0-9]{0,2})d(.*)");
    const fs::path folder = fs::path(pattern).parent_path(), listed = folder.empty() ? "." : folder;
    const std::string wanted = name_of(pattern);
    std::smatch match;
    if (!std::regex_match(wanted, match, form)) return std::nullopt;
    const std::string before = match[1], after = match[4];
    const std::size_t width = match[3].length() ? std::stoul(match[3]) : 1;
    Sequence sequence{(folder / before).string(), after};
    std::error_code none;
    for (const fs::path& file : fs::is_directory(listed, none) ? analysis::files_in(listed) : std::vector<fs::path>()) {
        const std::string name = file.filename().string();
        if (name.size() < before.size() + after.size() + width || !name.starts_with(before) || !name.ends_with(after)) continue;
        const std::string digits = name.substr(before.size(), name.size() - before.size() - after.size());
        const bool is_number = digits.size() <= longest_number && std::all_of(digits.begin(), digits.end(), is_digit);
        if (is_number && (digits.size() == width || digits[0] != '0')) sequence.add(digits, (folder / name).string());
    }
    return sequence;
}

std::vector<std::string> files_of(const std::string& argument)
{
    std::error_code error;
    if (fs::is_regular_file(argument, error)) return {argument};
    FoundFrames found;
    const bool is_folder = fs::is_directory(argument, error);
    if (is_folder)
        found = sequences_in(argument, in_folder(argument));
    else if (const auto sequence = of_number_pattern(argument)) {
        if (!sequence->files.empty()) found.sequences.push_back(*sequence);
    } else if (argument.find_first_of("*?[") != std::string::npos)
        found = sequences_in(argument, globbed(argument));
    else
        return {argument};
    if (is_folder) require_one_sequence(argument, found);
    std::vector<std::string> files = in_order(std::move(found));
    if (files.empty())
        throw pbs::InputError(argument, 0, "", "", "no such frames" + std::string(is_folder ? ": expected .vtu .vtk .msh .mesh .ele" : ""));
    return files;
}

}  // namespace

std::vector<std::string> frame_files(const std::vector<std::string>& arguments)
{
    std::vector<std::string> files;
    for (const std::string& argument : arguments)
        for (std::string& file : files_of(argument)) files.push_back(std::move(file));
    return files;
}

std::vector<std::string> frame_names(const std::vector<std::string>& paths)
{
    std::map<std::string, int> times;
    for (const std::string& path : paths) ++times[name_of(path)];
    std::vector<std::string> names;
    for (const std::string& path : paths) names.push_back(times[name_of(path)] > 1 ? path : name_of(path));
    return names;
}

}  // namespace experiments
