// The laws of the architecture, and the project's text files as they read them: from disk, or planted to show that a
// law detects violations.
#pragma once

#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace architecture {

// Path from the root, '/' between folders -> the file's text.
using SourceTree = std::map<std::string, std::string>;

// Violations of a law, as `path:line: what and why`.
using Violations = std::vector<std::string>;

// Sources, scripts, CMake files, scenes and pages of the project, without build folders, results, and dot folders
// except .ci.
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

// Headers of other projects that the file includes, directly or through headers of this project.
std::set<std::string> foreign_headers(const SourceTree& tree, const std::string& path);

std::string at(const std::string& path, int line, const std::string& what);

// The offence of each line of the files that the law concerns; "" if there is none.
Violations in_lines(const SourceTree& tree, const std::function<bool(const std::string& path)>& concerns,
                    const std::function<std::string(const std::string& line)>& offence);
// The offence is what the line should not have, where it matches. Every match contains one of `parts`. They are
// searched first, since a regular expression takes longer.
Violations in_lines(const SourceTree& tree, const std::function<bool(const std::string& path)>& concerns,
                    const std::regex& forbidden, const std::string& what, const std::vector<std::string>& parts = {""});

using Law = std::function<Violations(const SourceTree&)>;

// Which folder may include which: geometry < skinning < character; geometry < constraints < solver. The reference
// (reference_fem) and the metrics (analysis) share only the mesh with the method; the verification of the reference
// writes records (analysis/records). The experiments depend on all of them and have layers of their own, in which no
// study includes another one. A drawn figure computes nothing.
Violations include_direction(const SourceTree& tree);
Violations layer_direction(const SourceTree& tree);  // the layers inside of experiments
// includes of this project in quotes, from the root, of files that exist; headers with #pragma once
Violations include_form(const SourceTree& tree);
Violations values_compute(const SourceTree& tree);
// outside experiments/deformers/, where code uses their traits and options instead
Violations deformers_tested_by_name(const SourceTree& tree);

// Few .cpp files, of one place per library, include heavy headers (deal.II takes some 20 s per file), through whatever
// chain of includes, so that a change in the method recompiles in seconds.
Violations heavy_headers(const SourceTree& tree);

// Code that is built for one machine's instructions is isolated. Kernels use raw pointers and neither Eigen nor
// containers, whose inline code would otherwise differ from that of the rest of the program. No other code is built
// that way or includes SIMD headers.
Violations kernel_includes(const SourceTree& tree);    // headers that the sources of pbs_kernels must not include
Violations machine_flags(const SourceTree& tree);      // -march for a target that is not a kernel
Violations registers_at_home(const SourceTree& tree);  // SIMD headers included by code that is not a kernel

// Every source file is built, the unit tests mirror the source folders, and no table of cases is left unread.
Violations orphaned_sources(const SourceTree& tree);  // a .cpp that no CMake file names
Violations unit_mirror(const SourceTree& tree);       // tests/unit/A/... without a source folder A or pbs/A
Violations unread_tables(const SourceTree& tree);     // a table of a study's cases.toml that none of its sources names

// cmake/packages.txt is the one list of the project's requirements: it is well formed, and covers what the CMake files
// search for.
Violations package_list_form(const SourceTree& tree);
Violations package_list_cover(const SourceTree& tree);

// A function has 10 to 15 lines, 9 in 10 at most 60, none over 120; a line of source has at most 120 columns. Files
// have no limits.
Violations function_sizes(const SourceTree& tree);
Violations line_lengths(const SourceTree& tree);

// Texts that no file of the project may contain.
Violations absolute_paths(const SourceTree& tree);  // paths in a home or work folder
Violations unfinished_marks(const SourceTree& tree);
Violations stray_whitespace(const SourceTree& tree);  // tabs, and blanks at the end of a line

}  // namespace architecture
