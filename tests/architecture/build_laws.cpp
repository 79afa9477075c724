#include "tests/architecture/laws.hpp"

#include <algorithm>
#include <cctype>
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
    const auto belongs_to_a_word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
    };
    for (std::size_t place = text.find(word); place != std::string::npos; place = text.find(word, place + 1)) {
        const std::size_t end = place + word.size();
        if ((place == 0 || !belongs_to_a_word(text[place - 1])) &&
            (end == text.size() || !belongs_to_a_word(text[end])))
            return true;
    }
    return false;
}

// The words between NAME( and ), one list per call.
std::vector<std::vector<std::string>> calls_of(const std::string& name, const std::string& cmake)
{
    const std::string opening = name + "(";
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

// pbs_tests(KIND NAME FOLDERS FOLDER... FILES FILE... EXCEPT PATH...) compiles KIND/test.cpp. A variable holds the
// files that an option leaves out; it is not evaluated here.
bool compiles(const std::vector<std::string>& call, const std::string& kind, const std::string& test)
{
    if (call.empty() || call[0] != kind) return false;
    std::string section;
    bool in_folder = false, by_name = false, left_out = false;
    for (const std::string& word : call) {
        if (word == "FOLDERS" || word == "FILES" || word == "EXCEPT" || word == "LIBRARIES")
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
    return std::ranges::any_of(calls_of("pbs_tests", cmake), [&](const auto& call) {
        return compiles(call, test.substr(0, kind_end), test.substr(kind_end + 1));
    });
}

bool is_built(const std::string& cmake, const std::string& path)
{
    return names_word(cmake, path.substr(path.rfind('/') + 1)) ||
           (path.starts_with("tests/") && is_registered(cmake, path));
}

bool is_folder(const SourceTree& tree, const std::string& folder)
{
    return std::ranges::any_of(tree, [&](const auto& file) { return file.first.starts_with(folder + "/"); });
}

const std::vector<std::string> headers_of_kernels = {
    "array", "cmath", "cstddef", "cstdint", "limits", "utility", "type_traits", "experimental/simd", "immintrin.h"};
const std::vector<std::string> headers_of_registers = {"experimental/simd", "immintrin.h", "x86intrin.h", "arm_neon.h"};

// Targets built for the machine, and the definition that records this.
const std::vector<std::string> built_for_the_machine = {
    "target_compile_options(pbs_kernels ", "target_compile_options(pbskin_native_plain ", "\"PBS_KERNEL_FLAGS="};

// The sources of an add_library(NAME ...), with paths from the root.
std::vector<std::string> sources_of(const SourceTree& tree, const std::string& library)
{
    std::vector<std::string> sources;
    for (const auto& [path, text] : tree)
        for (const auto& call :
             is_cmake_file(path) ? calls_of("add_library", text) : std::vector<std::vector<std::string>>{})
            for (const std::string& word : call)
                if (call.front() == library && word.ends_with(".cpp")) sources.push_back(folder_of(path) + "/" + word);
    return sources;
}

bool names(const std::vector<std::string>& list, const std::string& entry)
{
    return std::ranges::count(list, entry) > 0;
}

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
    static const std::regex call(
        R"(^[^#]*\bfind_(?:(?:package|known)\s*\(\s*|library\s*\(\s*\w+\s+(?:NAMES\s+)?)([\w.+-]+))");
    std::smatch match;
    return std::regex_search(line, match, call) ? match[1].str() : "";
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

// StudyCase refuses keys that nothing reads; the tables beside [[case]] have no such owner.
Violations unread_tables(const SourceTree& tree)
{
    static const std::regex header(R"(^\s*\[\[?(\w+))");
    const std::string quotes = "\"\"\"";  // around a text of several lines
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!path.ends_with("/cases.toml")) continue;
        std::string sources = "\"case\"";  // that of study_cases.cpp
        for (const auto& [source, code] : tree)
            if (is_cpp(source) && folder_of(source) == folder_of(path)) sources += code;
        const std::vector<std::string> lines = lines_of(text);
        bool in_text = false;
        for (std::size_t line = 0; line < lines.size(); ++line) {
            std::smatch table;
            if (!in_text && std::regex_search(lines[line], table, header) &&
                sources.find('"' + table.str(1) + '"') == std::string::npos)
                violations.push_back(
                    at(path, static_cast<int>(line) + 1, "no source of the study reads the table " + table.str(1)));
            for (auto found = lines[line].find(quotes); found != std::string::npos;
                 found = lines[line].find(quotes, found + quotes.size()))
                in_text = !in_text;
        }
    }
    return violations;
}

Violations kernel_includes(const SourceTree& tree)
{
    Violations violations;
    const std::vector<std::string> sources = sources_of(tree, "pbs_kernels");
    if (sources.empty()) violations.push_back("pbs_kernels has no sources");
    for (const std::string& path : sources)
        for (const std::string& header : foreign_headers(tree, path))
            if (!names(headers_of_kernels, header)) violations.push_back(at(path, 1, "a kernel sees <" + header + ">"));
    return violations;
}

Violations machine_flags(const SourceTree& tree)
{
    return in_lines(tree, is_cmake_file, [](const std::string& line) {
        const std::string code = line.substr(0, line.find('#'));
        const auto says = [&](const std::string& part) { return code.find(part) != std::string::npos; };
        const bool is_for_one = says("-march") || says("-mtune") || says("-mavx");
        return is_for_one && std::ranges::none_of(built_for_the_machine, says) ? "built for one machine, and no kernel"
                                                                               : "";
    });
}

Violations registers_at_home(const SourceTree& tree)
{
    const std::vector<std::string> kernels = sources_of(tree, "pbs_kernels");
    Violations violations;
    for (const auto& [path, text] : tree)
        if (path.ends_with(".cpp") && !names(kernels, path))
            for (const std::string& header : foreign_headers(tree, path))
                if (names(headers_of_registers, header))
                    violations.push_back(at(path, 1, "no kernel, and sees <" + header + ">"));
    return violations;
}

Violations package_list_form(const SourceTree& tree)
{
    static const std::regex entry(
        R"([a-z0-9][a-z0-9+.-]+ +[0-9][0-9.]* +(?:[0-9][0-9.]*|-) +(run|full|check|long) +(\[[\w.+, -]+\] )?\w.*)");
    Violations violations;
    std::set<std::string> packages;
    int number = 0;
    for (const std::string& line : package_lines(tree)) {
        ++number;
        if (line.empty() || line.starts_with('#')) continue;
        if (!std::regex_match(line, entry))
            violations.push_back(at(list, number, "expected: package oldest newest group [names] purpose"));
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
    return in_lines(tree, is_cmake_file, [&](const std::string& line) {
        const std::string name = looked_for(line);
        return name.empty() || known.contains(name) ? "" : name + " is in no [...] of " + list;
    });
}

}  // namespace architecture
