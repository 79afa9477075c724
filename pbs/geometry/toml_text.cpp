#include "pbs/geometry/toml_text.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <sstream>

namespace pbs {
namespace {

// Dots of the longest key, which ends with '='; those of texts, comments and of numbers in a list are none.
int dots_of_key(const std::string& line)
{
    int dots = 0, most = 0;
    char quote = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (quote) {
            if (c == quote) quote = 0;
            if (c == '\\' && quote == '"') ++i;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '=' || c == '#') {
            break;
        } else {
            dots = c == ',' ? 0 : dots + (c == '.');
            most = std::max(most, dots);
        }
    }
    return most;
}

}  // namespace

void check_toml_keys(const std::string& text, const std::string& file)
{
    constexpr int most_parts = 64;
    std::istringstream lines(text);
    const bool many_lines =
        text.find("\"\"\"") != std::string::npos || text.find("'''") != std::string::npos;  // texts of many lines hold what they will
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::string bare = line.substr(0, line.find_first_of("#\"'"));  // TOML's bare words are ASCII
        const auto strange =
            std::find_if(bare.begin(), bare.end(), [](unsigned char c) { return c < ' ' ? c != '\t' && c != '\r' : c > '~'; });
        if (strange != bare.end() && !many_lines)
            throw InputError(file, number, "byte", std::to_string(static_cast<unsigned char>(*strange)), "expected ASCII outside of texts");
        if (dots_of_key(line) >= most_parts)
            throw InputError(file, number, "key", line.substr(0, 40) + "...", "nested too deep: expected at most 64 parts");
    }
}

}  // namespace pbs
