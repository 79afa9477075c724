// Bad input, refused at the door: file, line, field, value and the rule it breaks.
//   throw InputError("limb.toml", 12, "k_volume", "1.4", "expected 0 <= k <= 1");
// prints as  limb.toml:12: k_volume = 1.4: expected 0 <= k <= 1  and ends the program with exit status 2.
#pragma once

#include <stdexcept>
#include <string>

namespace pbs {

// what() is that one line. It is what is thrown wherever a comment says "an InputError".
class InputError : public std::runtime_error {
public:
    // line 0: no line is known; an empty field or value is left out, a long one cut to 80 bytes. The message is one line: control
    // characters stand in it by their codes (\n, \x1b).
    InputError(const std::string& file, int line, const std::string& field, const std::string& value, const std::string& rule);
};

}  // namespace pbs
