#include "experiments/command_line/measure/frame_numbers.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// A name cut at its numbers: text, number, text, ..., text.
std::vector<std::string> cut_at_numbers(const std::string& name)
{
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
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

NumberedFile numbered_at(std::size_t at, const std::string& path, const std::vector<std::string>& pieces)
{
    NumberedFile file{path, "", pieces[at], ""};
    for (std::size_t i = 0; i < at; ++i) file.before += pieces[i];
    for (std::size_t i = at + 1; i < pieces.size(); ++i) file.after += pieces[i];
    file.before = (fs::path(path).parent_path() / file.before).string();
    return file;
}

// Which pieces are numbers that differ between names of one form.
std::set<std::size_t> differing_numbers(const std::vector<std::vector<std::string>>& names)
{
    std::set<std::size_t> differing;
    for (const auto& name : names)
        for (std::size_t i = 1; i < name.size(); i += 2)
            if (name[i] != names.front()[i]) differing.insert(i);
    return differing;
}

// Files of one form, as frame_0007_v2.vtu and frame_0008_v2.vtu: the number that differs counts; of a single name the last.
std::vector<NumberedFile> numbered_alike(const std::string& argument, const std::vector<std::string>& paths)
{
    std::vector<std::vector<std::string>> names;
    for (const std::string& path : paths) names.push_back(cut_at_numbers(fs::path(path).filename().string()));
    const std::set<std::size_t> differing = differing_numbers(names);
    if (differing.size() > 1)
        throw pbs::InputError(argument, 0, "", "",
                              fmt::format("expected frames that differ in one number, found {} and {}; name one sequence, as in "
                                          "'NAME_%04d.vtu'",
                                          paths.front(), paths.back()));
    std::vector<NumberedFile> files;
    for (std::size_t i = 0; i < paths.size(); ++i)
        files.push_back(names[i].size() == 1
                            ? NumberedFile{paths[i], "", "", ""}
                            : numbered_at(differing.empty() ? names[i].size() - 2 : *differing.begin(), paths[i], names[i]));
    return files;
}

}  // namespace

std::vector<NumberedFile> numbered(const std::string& argument, const std::vector<std::string>& paths)
{
    std::map<std::vector<std::string>, std::vector<std::string>> forms;  // folder and texts of a name -> paths
    for (const std::string& path : paths) {
        const std::vector<std::string> pieces = cut_at_numbers(fs::path(path).filename().string());
        std::vector<std::string> form = {fs::path(path).parent_path().string()};
        for (std::size_t i = 0; i < pieces.size(); i += 2) form.push_back(pieces[i]);
        forms[form].push_back(path);
    }
    std::vector<NumberedFile> files;
    for (const auto& [form, alike] : forms)
        for (NumberedFile& file : numbered_alike(argument, alike)) files.push_back(std::move(file));
    return files;
}

}  // namespace experiments
