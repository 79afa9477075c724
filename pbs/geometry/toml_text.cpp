#include "pbs/geometry/toml_text.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <sstream>

namespace pbs {

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
        const auto dots = std::count(line.begin(), std::find(line.begin(), line.end(), '='), '.');
        const bool comment_or_text = line.find_first_of("#\"'") < line.find('.');
        if (dots >= most_parts && !comment_or_text)
            throw InputError(file, number, "key", line.substr(0, 40) + "...", "nested too deep: expected at most 64 parts");
    }
}

}  // namespace pbs
