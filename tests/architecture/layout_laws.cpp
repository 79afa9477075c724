#include "tests/architecture/laws.hpp"

#include <algorithm>

namespace architecture {
namespace {

constexpr int longest_function = 120, usual_function = 60, longest_line = 120;

struct Function {
    int line, lines;
};

bool is_line_of_source(const std::string& path)
{
    return is_cpp(path) || is_cmake_file(path) || is_command(path) ||
           ends_with_any(path, {".py", ".sh", ".js", ".mjs", ".css", "Snakefile"});
}

bool any_file(const std::string&)
{
    return true;
}

// The number of characters of UTF-8 text: bytes that do not continue a character.
int columns_of(const std::string& line)
{
    return static_cast<int>(std::ranges::count_if(line, [](char byte) { return (byte & 0xC0) != 0x80; }));
}

// In this format a function's braces are alone on their lines, with the indentation of its signature; so are those of
// loops and branches.
std::vector<Function> functions_of(const std::vector<std::string>& lines)
{
    static const std::regex control(R"(^\s*(for|if|else|while|switch|do|try|catch|struct|class|enum|union)\b)");
    std::vector<Function> functions;
    for (std::size_t open = 1; open < lines.size(); ++open) {
        const std::size_t indentation = lines[open].find('{');
        if (indentation == std::string::npos || lines[open].size() != indentation + 1 ||
            lines[open].find_first_not_of(' ') != indentation)
            continue;
        if (std::regex_search(lines[open - 1], control)) continue;
        const std::string closing = std::string(indentation, ' ') + "}";
        std::size_t close = open;
        while (close + 1 < lines.size() && !lines[close].starts_with(closing)) ++close;
        functions.push_back({static_cast<int>(open), static_cast<int>(close - open) + 1});
        open = close;
    }
    return functions;
}

}  // namespace

Violations function_sizes(const SourceTree& tree)
{
    Violations violations, above_usual;
    std::size_t functions = 0;
    for (const auto& [path, text] : tree)
        for (const auto& [line, lines] : is_cpp(path) ? functions_of(lines_of(text)) : std::vector<Function>{}) {
            ++functions;
            const std::string what = at(path, line, "function of " + std::to_string(lines) + " lines");
            if (lines > longest_function) violations.push_back(what + ", at most " + std::to_string(longest_function));
            if (lines > usual_function)
                above_usual.push_back(what + ", and more than 1 in 10 have over " + std::to_string(usual_function));
        }
    if (10 * above_usual.size() > functions)
        violations.insert(violations.end(), above_usual.begin(), above_usual.end());
    return violations;
}

Violations line_lengths(const SourceTree& tree)
{
    return in_lines(tree, is_line_of_source, [](const std::string& line) {
        const int columns = columns_of(line);
        return columns > longest_line ? std::to_string(columns) + " columns, at most " + std::to_string(longest_line)
                                      : "";
    });
}

Violations absolute_paths(const SourceTree& tree)
{
    static const std::regex folder(R"((^|[^\w.])/(home|root|work|Users)/\w)");
    return in_lines(tree, any_file, folder, "a path of one machine", {"home/", "root/", "work/", "Users/"});
}

Violations unfinished_marks(const SourceTree& tree)
{
    static const std::regex mark(R"(\b(TO[D]O|FIX[M]E|XX[X]|HAC[K])\b)");
    return in_lines(tree, any_file, mark, "finish it, or open an issue", {"TOD", "FIX", "XX", "HAC"});
}

Violations stray_whitespace(const SourceTree& tree)
{
    return in_lines(tree, any_file, [](const std::string& line) {
        return line.find('\t') != std::string::npos || line.ends_with(' ') ? "a tab, or blanks at the end of the line"
                                                                           : "";
    });
}

}  // namespace architecture
