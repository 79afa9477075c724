#include "tests/architecture/build_laws.hpp"

#include <algorithm>
#include <cctype>

namespace architecture {
namespace {

// CMake text of the folder and those above it, without comments.
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

// Registered by pbs_test(KIND FOLDER/NAME), or by pbs_test(KIND FOLDER/${name}) over a list that holds NAME.
bool is_registered(const std::string& cmake, const std::string& path)
{
    std::string test = path.substr(path.find('/') + 1, path.rfind('.') - path.find('/') - 1);  // KIND/FOLDER/NAME
    if (const std::size_t kind_end = test.find('/'); kind_end != std::string::npos) test[kind_end] = ' ';
    const std::size_t name = test.find_last_of("/ ") + 1;
    return names_word(cmake, test) ||
           (cmake.find(test.substr(0, name) + "${") != std::string::npos && names_word(cmake, test.substr(name)));
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
