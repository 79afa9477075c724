#include "experiments/command_line/measure/frame_files.hpp"

#include "experiments/command_line/measure/frame_numbers.hpp"
#include "analysis/records/folder_files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <set>

namespace experiments {
namespace {

namespace fs = std::filesystem;

struct Sequence {
    std::string before, after;
    std::size_t width = 0;                   // of its shortest number
    std::map<long long, std::string> files;  // by number
};

void require_no_gap(const Sequence& sequence)
{
    const auto& files = sequence.files;
    long long step = std::numeric_limits<long long>::max();
    for (auto file = files.begin(); std::next(file) != files.end(); ++file) step = std::min(step, std::next(file)->first - file->first);
    for (auto file = files.begin(); std::next(file) != files.end(); ++file) {
        const long long wanted = file->first + step;
        if (std::next(file)->first != wanted)
            throw pbs::InputError(
                fmt::format("{}{:0{}}{}", sequence.before, wanted, sequence.width, sequence.after), 0, "frame", std::to_string(wanted),
                fmt::format("missing: the sequence goes from {} to {} by {}", files.begin()->first, files.rbegin()->first, step));
    }
}

// In the order of their numbers, one sequence after the other; those without a number first.
std::vector<std::string> ordered(const std::string& argument, const std::vector<NumberedFile>& found, bool one_sequence)
{
    std::map<std::pair<std::string, std::string>, Sequence> sequences;
    std::vector<std::string> files;
    for (const NumberedFile& file : found) {
        if (file.digits.empty()) {
            files.push_back(file.path);
            continue;
        }
        Sequence& sequence = sequences[{file.before, file.after}];
        sequence.before = file.before;
        sequence.after = file.after;
        sequence.width = sequence.files.empty() ? file.digits.size() : std::min(sequence.width, file.digits.size());
        const auto [at, is_new] = sequence.files.emplace(std::stoll(file.digits), file.path);
        if (!is_new) throw pbs::InputError(file.path, 0, "frame", file.digits, "the same number as " + at->second);
    }
    if (one_sequence && sequences.size() + files.size() > 1 && !(sequences.empty())) {
        std::vector<std::string> names;
        for (const auto& [key, sequence] : sequences) names.push_back(sequence.files.begin()->second);
        names.insert(names.end(), files.begin(), files.end());
        throw pbs::InputError(
            argument, 0, "", "",
            fmt::format("expected one sequence of frames, found those of {}; name one, as in 'NAME_%04d.vtu'", fmt::join(names, ", ")));
    }
    for (const auto& [key, sequence] : sequences) {
        require_no_gap(sequence);
        for (const auto& [number, path] : sequence.files) files.push_back(path);
    }
    return files;
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
std::optional<std::vector<NumberedFile>> of_number_pattern(const std::string& pattern)
{
    static const std::regex form("(.*)%(0?)([0-9]{0,2})d(.*)");
    const fs::path folder = fs::path(pattern).parent_path();
    const std::string wanted = fs::path(pattern).filename().string();
    std::smatch match;
    if (!std::regex_match(wanted, match, form)) return std::nullopt;
    const std::string before = match[1], after = match[4];
    const std::size_t width = match[3].length() ? std::stoul(match[3]) : 1;
    std::vector<NumberedFile> files;
    const fs::path listed = folder.empty() ? "." : folder;
    std::error_code none;
    for (const fs::path& file : fs::is_directory(listed, none) ? analysis::files_in(listed) : std::vector<fs::path>()) {
        const std::string name = file.filename().string();
        if (name.size() < before.size() + after.size() + width || !name.starts_with(before) || !name.ends_with(after)) continue;
        const std::string digits = name.substr(before.size(), name.size() - before.size() - after.size());
        const bool is_number =
            digits.size() <= longest_number && std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c); });
        if (is_number && (digits.size() == width || digits[0] != '0'))
            files.push_back({(folder / name).string(), (folder / before).string(), digits, after});
    }
    return files;
}

std::vector<std::string> files_of(const std::string& argument)
{
    std::error_code error;
    if (fs::is_regular_file(argument, error)) return {argument};
    std::vector<NumberedFile> files;
    const bool is_folder = fs::is_directory(argument, error);
    if (is_folder)
        files = numbered(argument, in_folder(argument));
    else if (const auto numbers = of_number_pattern(argument))
        files = *numbers;
    else if (argument.find_first_of("*?[") != std::string::npos)
        files = numbered(argument, globbed(argument));
    else
        return {argument};
    if (files.empty())
        throw pbs::InputError(argument, 0, "", "", "no such frames" + std::string(is_folder ? ": expected .vtu .vtk .msh .mesh .ele" : ""));
    return ordered(argument, files, is_folder);
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
    for (const std::string& path : paths) ++times[fs::path(path).filename().string()];
    std::vector<std::string> names;
    for (const std::string& path : paths) {
        const std::string name = fs::path(path).filename().string();
        names.push_back(times[name] > 1 ? path : name);
    }
    return names;
}

}  // namespace experiments
