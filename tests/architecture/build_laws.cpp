#include "tests/architecture/build_laws.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>

namespace architecture {
namespace {

// The CMake text of the folder and of those above it, without comments.
std::string cmake_text_above(const SourceTree& tree, const std::string& path)
{
    std::string all;
    for (const auto& [file, text] : tree)
        if (is_cmake_file(file) && (folder_of(file).empty() || path.starts_with(folder_of(file) + "/")))
            for (const std::string& line : lines_of(text)) all += line.substr(0, line.find('#')) + "\n";
    return all;
}

bool names_word(const std::string& text, const std::string& word)
{
    const auto belongs_to_a_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; };
    for (std::size_t place = text.find(word); place != std::string::npos; place = text.find(word, place + 1)) {
        const std::size_t end = place + word.size();
        if ((place == 0 || !belongs_to_a_word(text[place - 1])) && (end == text.size() || !belongs_to_a_word(text[end]))) return true;
    }
    return false;
}

// The words between "pbs_tests(" and ")", one list per call.
std::vector<std::vector<std::string>> calls_of_pbs_tests(const std::string& cmake)
{
    const std::string opening = "pbs_tests(";
    std::vector<std::vector<std::string>> calls;
    for (std::size_t place = cmake.find(opening); place != std::string::npos; place = cmake.find(opening, place + 1)) {
        const std::size_t start = place + opening.size();
        std::istringstream words(cmake.substr(start, cmake.find(')', start) - start));
        calls.emplace_back(std::istream_iterator<std::string>(words), std::istream_iterator<std::string>());
    }
    return calls;
}

bool is_below(const std::string& path, const std::string& folder)
{
    return folder == "." || path == folder || path.starts_with(folder + "/");
}

// pbs_tests(KIND NAME FOLDERS FOLDER... FILES FILE... EXCEPT PATH... ALONE FILE...) compiles KIND/test.cpp. A variable holds the files that
// an option leaves out; it is not evaluated here.
bool compiles(const std::vector<std::string>& call, const std::string& kind, const std::string& test)
{
    if (call.empty() || call[0] != kind) return false;
    std::string section;
    bool in_folder = false, by_name = false, left_out = false;
    for (const std::string& word : call) {
        if (word == "FOLDERS" || word == "FILES" || word == "EXCEPT" || word == "ALONE" || word == "LIBRARIES")
            section = word;
        else if (section == "FOLDERS")
            in_folder |= is_below(test, word);
        else if (section == "FILES")
            by_name |= test == word;
        else if (section == "EXCEPT")
            left_out |= is_below(test, word);
    }
    return by_name || (in_folder && !left_out);
}

bool is_registered(const std::string& cmake, const std::string& path)
{
    const std::string test = path.substr(path.find('/') + 1, path.rfind('.') - path.find('/') - 1);  // KIND/FOLDER/NAME
    const std::size_t kind_end = test.find('/');
    if (kind_end == std::string::npos) return false;
    return std::ranges::any_of(calls_of_pbs_tests(cmake),
                               [&](const auto& call) { return compiles(call, test.substr(0, kind_end), test.substr(kind_end + 1)); });
}

bool is_built(const std::string& cmake, const std::string& path)
{
    return names_word(cmake, path.substr(path.rfind('/') + 1)) || (path.starts_with("tests/") && is_registered(cmake, path));
}

bool is_folder(const SourceTree& tree, const std::string& folder)
{
    return std::ranges::any_of(tree, [&](const auto& file) { return file.first.starts_with(folder + "/"); });
}

}  // namespace

Violations orphaned_sources(const SourceTree& tree)
{
    Violations violations;
    for (const auto& [path, text] : tree)
        if (path.ends_with(".cpp") && !is_built(cmake_text_above(tree, path), path))
            violations.push_back(at(path, 1, "no CMake file at or above it names it"));
    return violations;
}

Violations unit_mirror(const SourceTree& tree)
{
    const std::string units = "tests/unit/";
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!path.starts_with(units) || !is_cpp(path)) continue;
        const std::string mirrored = folder_of(path.substr(units.size()));
        if (mirrored.empty() || (!is_folder(tree, mirrored) && !is_folder(tree, "pbs/" + mirrored)))
            violations.push_back(at(path, 1, "mirrors no source folder '" + mirrored + "'"));
    }
    return violations;
}

}  // namespace architecture
