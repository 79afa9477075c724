#include "experiments/measure/frame_files.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <set>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// frames_0007.vtu: the last number in the name counts.
struct Sequence {
    std::string before, after;
    std::size_t width = 0;                   // of its shortest number
    std::map<long long, std::string> files;  // by number
};

struct NumberedName {
    std::string before, digits, after;
};

std::optional<NumberedName> numbered(const std::string& path)
{
    static const std::regex form("(.*?)([0-9]{1,15})([^0-9]*)");
    const fs::path file(path);
    const std::string name = file.filename().string();
    std::smatch match;
    if (!std::regex_match(name, match, form)) return std::nullopt;
    return NumberedName{(file.parent_path() / match[1].str()).string(), match[2].str(), match[3].str()};
}

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
std::vector<std::string> ordered(const std::string& argument, const std::vector<std::string>& found, bool one_sequence)
{
    std::map<std::pair<std::string, std::string>, Sequence> sequences;
    std::vector<std::string> files;
    for (const std::string& path : found) {
        const auto name = numbered(path);
        if (!name) {
            files.push_back(path);
            continue;
        }
        Sequence& sequence = sequences[{name->before, name->after}];
        sequence.before = name->before;
        sequence.after = name->after;
        sequence.width = sequence.files.empty() ? name->digits.size() : std::min(sequence.width, name->digits.size());
        const auto [at, is_new] = sequence.files.emplace(std::stoll(name->digits), path);
        if (!is_new) throw pbs::InputError(path, 0, "frame", name->digits, "the same number as " + at->second);
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
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && is_mesh(entry.path())) files.push_back(entry.path().string());
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
std::optional<std::vector<std::string>> of_number_pattern(const std::string& pattern)
{
    static const std::regex form("(.*)%(0?)([0-9]{0,2})d(.*)");
    std::smatch match;
    if (!std::regex_match(pattern, match, form)) return std::nullopt;
    const std::string before = match[1], after = match[4];
    const std::size_t width = match[3].length() ? std::stoul(match[3]) : 1;
    std::vector<std::string> files;
    const fs::path folder = fs::path(pattern).parent_path();
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, error)) {
        const std::string path = (folder / entry.path().filename()).string();
        if (path.size() < before.size() + after.size() + width || !path.starts_with(before) || !path.ends_with(after)) continue;
        const std::string digits = path.substr(before.size(), path.size() - before.size() - after.size());
        const bool is_number = std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c); });
        if (is_number && (digits.size() == width || digits[0] != '0')) files.push_back(path);
    }
    return files;
}

std::vector<std::string> files_of(const std::string& argument)
{
    std::error_code error;
    if (fs::is_regular_file(argument, error)) return {argument};
    std::vector<std::string> files;
    const bool is_folder = fs::is_directory(argument, error);
    if (is_folder)
        files = in_folder(argument);
    else if (const auto numbers = of_number_pattern(argument))
        files = *numbers;
    else if (argument.find_first_of("*?[") != std::string::npos)
        files = globbed(argument);
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

}  // namespace experiments
