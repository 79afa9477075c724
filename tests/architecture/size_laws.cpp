#include "tests/architecture/size_laws.hpp"

#include <algorithm>
#include <regex>

namespace architecture {
namespace {

constexpr int longest_file = 500, usual_file = 200, longest_function = 120, usual_function = 60, longest_line = 140;

struct Sized {
    std::string path;
    int line;
    int lines;
};

bool is_source(const std::string& path)
{
    return is_cpp(path) || is_cmake_file(path) || ends_with_any(path, {".py", ".sh"});
}

bool is_line_of_source(const std::string& path)
{
    return is_source(path) || is_command(path) || ends_with_any(path, {".js", ".mjs", ".css", "Snakefile"});
}

// The number of characters of UTF-8 text: bytes that do not continue a character.
int columns_of(const std::string& line)
{
    return static_cast<int>(std::ranges::count_if(line, [](char byte) { return (byte & 0xC0) != 0x80; }));
}

// Violations for sizes above the limit, or if more than one in ten exceeds the usual size.
Violations judge(const std::vector<Sized>& all, int longest, int usual, const std::string& thing)
{
    Violations violations, above_usual;
    for (const auto& [path, line, lines] : all) {
        const std::string what = at(path, line, thing + " of " + std::to_string(lines) + " lines");
        if (lines > longest) violations.push_back(what + ", at most " + std::to_string(longest));
        if (lines > usual) above_usual.push_back(what + ", and more than 1 in 10 have over " + std::to_string(usual));
    }
    if (10 * above_usual.size() > all.size()) violations.insert(violations.end(), above_usual.begin(), above_usual.end());
    return violations;
}

// In this format a function's braces are alone on their lines, with the indentation of its signature; so are those of loops and branches.
std::vector<Sized> functions_of(const std::string& path, const std::vector<std::string>& lines)
{
    static const std::regex control(R"(^\s*(for|if|else|while|switch|do|try|catch|struct|class|enum|union)\b)");
    std::vector<Sized> functions;
    for (std::size_t open = 1; open < lines.size(); ++open) {
        const std::size_t indentation = lines[open].find('{');
        if (indentation == std::string::npos || lines[open].size() != indentation + 1 || lines[open].find_first_not_of(' ') != indentation)
            continue;
        if (std::regex_search(lines[open - 1], control)) continue;
        const std::string closing = std::string(indentation, ' ') + "}";
        std::size_t close = open;
        while (close + 1 < lines.size() && !lines[close].starts_with(closing)) ++close;
        functions.push_back({path, static_cast<int>(open), static_cast<int>(close - open) + 1});
        open = close;
    }
    return functions;
}

}  // namespace

Violations file_sizes(const SourceTree& tree)
{
    std::vector<Sized> files;
    for (const auto& [path, text] : tree)
        if (is_source(path)) files.push_back({path, 1, static_cast<int>(lines_of(text).size())});
    return judge(files, longest_file, usual_file, "file");
}

Violations function_sizes(const SourceTree& tree)
{
    std::vector<Sized> functions;
    for (const auto& [path, text] : tree)
        if (is_cpp(path)) {
            const std::vector<Sized> found = functions_of(path, lines_of(text));
            functions.insert(functions.end(), found.begin(), found.end());
        }
    return judge(functions, longest_function, usual_function, "function");
}

Violations line_lengths(const SourceTree& tree)
{
    Violations violations;
    for (const auto& [path, text] : tree) {
        int number = 0;
        for (const std::string& line : is_line_of_source(path) ? lines_of(text) : std::vector<std::string>{}) {
            ++number;
            const int columns = columns_of(line);
            if (columns > longest_line)
                violations.push_back(at(path, number, std::to_string(columns) + " columns, at most " + std::to_string(longest_line)));
        }
    }
    return violations;
}

}  // namespace architecture
