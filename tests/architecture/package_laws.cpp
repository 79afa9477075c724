#include "tests/architecture/package_laws.hpp"

#include <regex>
#include <set>
#include <sstream>

namespace architecture {
namespace {

const std::string list = "cmake/packages.txt";

std::vector<std::string> package_lines(const SourceTree& tree)
{
    const auto file = tree.find(list);
    return file == tree.end() ? std::vector<std::string>{} : lines_of(file->second);
}

// The names in square brackets.
std::set<std::string> known_to_cmake(const SourceTree& tree)
{
    std::set<std::string> names;
    for (const std::string& line : package_lines(tree)) {
        const std::size_t open = line.find('['), close = line.find(']');
        if (line.starts_with('#') || open == std::string::npos || close == std::string::npos) continue;
        std::istringstream inside(line.substr(open + 1, close - open - 1));
        for (std::string name; std::getline(inside >> std::ws, name, ',');) names.insert(name);
    }
    return names;
}

// The name that is searched for: find_package(NAME ...), or find_library(VARIABLE NAME ...), also with NAMES before it.
std::string looked_for(const std::string& line)
{
    static const std::regex call(R"(^[^#]*\bfind_(?:package\s*\(\s*|library\s*\(\s*\w+\s+(?:NAMES\s+)?)([\w.+-]+))");
    std::smatch match;
    return std::regex_search(line, match, call) ? match[1].str() : "";
}

}  // namespace

Violations package_list_form(const SourceTree& tree)
{
    static const std::regex entry(R"([a-z0-9][a-z0-9+.-]+ +[0-9][\w.+:~-]* +(run|full|check|long) +(\[[\w.+, -]+\] )?\w.*)");
    Violations violations;
    std::set<std::string> packages;
    int number = 0;
    for (const std::string& line : package_lines(tree)) {
        ++number;
        if (line.empty() || line.starts_with('#')) continue;
        if (!std::regex_match(line, entry)) violations.push_back(at(list, number, "expected: package version group [names] purpose"));
        const std::string package = line.substr(0, line.find(' '));
        if (!packages.insert(package).second) violations.push_back(at(list, number, package + " twice"));
    }
    if (packages.empty()) violations.push_back(at(list, 1, "no packages"));
    return violations;
}

Violations package_list_cover(const SourceTree& tree)
{
    std::set<std::string> known = known_to_cmake(tree);
    known.insert("pbs");  // this project, which tests/packaging finds
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!is_cmake_file(path)) continue;
        int number = 0;
        for (const std::string& line : lines_of(text)) {
            ++number;
            const std::string name = looked_for(line);
            if (!name.empty() && !known.contains(name)) violations.push_back(at(path, number, name + " is in no [...] of " + list));
        }
    }
    return violations;
}

}  // namespace architecture
