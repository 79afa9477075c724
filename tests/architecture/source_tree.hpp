// The project's text files as the architecture tests read them: from disk, or planted to show that a law detects violations.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace architecture {

// Path from the root, '/' between folders -> the file's text.
using SourceTree = std::map<std::string, std::string>;

// Violations of a law, as `path:line: what and why`.
using Violations = std::vector<std::string>;

// Sources, scripts, CMake files, scenes and pages of the project, without build folders, results, and dot folders except .ci.
SourceTree read_source_tree();

std::vector<std::string> lines_of(const std::string& text);
std::string folder_of(const std::string& path);
bool starts_with_any(std::string_view text, const std::vector<std::string>& prefixes);
bool ends_with_any(std::string_view text, const std::vector<std::string>& suffixes);
bool is_cpp(const std::string& path);         // .cpp or .hpp
bool is_cmake_file(const std::string& path);  // CMakeLists.txt or .cmake
bool is_command(const std::string& path);     // a script without a suffix that users start

struct Include {
    int line;
    std::string target;
    bool quoted;
};
std::vector<Include> includes_of(const std::string& text);

std::string at(const std::string& path, int line, const std::string& what);

}  // namespace architecture
