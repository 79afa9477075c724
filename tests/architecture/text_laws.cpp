#include "tests/architecture/text_laws.hpp"

#include <functional>
#include <regex>

namespace architecture {
namespace {

Violations in_every_line(const SourceTree& tree, const std::function<bool(const std::string&)>& offends, const std::string& what)
{
    Violations violations;
    for (const auto& [path, text] : tree) {
        int number = 0;
        for (const std::string& line : lines_of(text)) {
            ++number;
            if (offends(line)) violations.push_back(at(path, number, what));
        }
    }
    return violations;
}

}  // namespace

Violations absolute_paths(const SourceTree& tree)
{
    static const std::regex home(R"((^|[^\w.])/(home|root|work|Users)/\w)");
    return in_every_line(
        tree, [](const std::string& line) { return std::regex_search(line, home); }, "a path of one machine");
}

Violations unfinished_marks(const SourceTree& tree)
{
    static const std::regex mark(R"(\b(TO[D]O|FIX[M]E|XX[X]|HAC[K])\b)");
    return in_every_line(
        tree, [](const std::string& line) { return std::regex_search(line, mark); }, "finish it, or open an issue");
}

Violations stray_whitespace(const SourceTree& tree)
{
    const auto offends = [](const std::string& line) { return line.find('\t') != std::string::npos || line.ends_with(' '); };
    return in_every_line(tree, offends, "a tab, or blanks at the end of the line");
}

}  // namespace architecture
