// Bad input, refused at the door: file, line, field, value and the rule it breaks.
//   throw InputError("limb.toml", 12, "k_volume", "1.4", "expected 0 <= k <= 1");
// prints as  limb.toml:12: k_volume = 1.4: expected 0 <= k <= 1  and ends the program with exit status 2.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace pbs {

// what() is that one line. It is what is thrown wherever a comment says "an InputError".
class InputError : public std::runtime_error {
public:
    // line 0: no line is known; an empty field or value is left out, a long one cut to 80 bytes. The message is one
    // line: control characters and bytes that are no UTF-8 stand in it by their codes (\n, \x1b).
    InputError(const std::string& file, int line, const std::string& field, const std::string& value,
               const std::string& rule);
};

// "expected an index from 0 to 7"; where one number alone is right, "expected 3". `what` with its article.
inline std::string expected_whole(const std::string& what, long long low, long long high)
{
    if (low == high) return "expected " + std::to_string(low);
    return "expected " + what + " from " + std::to_string(low) + " to " + std::to_string(high);
}

// So many digits whatever the magnitude: 1e-300 is no 0.000000.
inline std::string number_text(double number, int digits = 6)
{
    std::ostringstream text;
    text.precision(digits);
    text << number;
    return text.str();
}

// The line of a byte of the text, from 1.
int line_at(const std::string& text, std::size_t byte);

// All names if there are at most six; otherwise "a, b, c, d, e, f and 2 others".
std::string name_list(const std::vector<std::string>& names);

// The known name nearest to a mistyped one by edit distance (Levenshtein), the first of equals; empty where there are
// none.
//   throw InputError(file, line, key, "", "unknown key; the nearest known one is " + nearest_name(key, known));
std::string nearest_name(const std::string& name, const std::vector<std::string>& known);

}  // namespace pbs
