// Numbers as error messages print them.
#pragma once

#include <sstream>
#include <string>

namespace pbs {

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

// "(0, 0.5, 1)"
template <typename Row>
std::string place_text(const Row& place)
{
    std::ostringstream text;
    text << '(' << place(0) << ", " << place(1) << ", " << place(2) << ')';
    return text.str();
}

}  // namespace pbs
