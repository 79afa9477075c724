#include "pbs/geometry/toml_text.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <sstream>

namespace pbs {

void check_toml_keys(const std::string& text, const std::string& file)
{
    constexpr int most_parts = 64;
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const auto dots = std::count(line.begin(), std::find(line.begin(), line.end(), '='), '.');
        const bool comment_or_text = line.find_first_of("#\"'") < line.find('.');
        if (dots >= most_parts && !comment_or_text)
            throw InputError(file, number, "key", line.substr(0, 40) + "...", "nested too deep: expected at most 64 parts");
    }
}

}  // namespace pbs
