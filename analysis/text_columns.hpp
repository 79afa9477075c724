// Text for a terminal: broken between words to a width, and columns side by side.
//   fmt::print("{}", side_by_side({{"C02", 4}, {"reproduced only for", 14}, {statement, 40}}));
#pragma once

#include <string>
#include <vector>

namespace analysis {

// Lines of at most `width` characters (of UTF-8, not bytes); a word that is longer is broken, a line break in the text is kept.
std::vector<std::string> wrapped(const std::string& text, std::size_t width);

std::size_t characters(const std::string& text);  // of UTF-8: code points

// A cell of a row, broken where it is too wide.
struct TextColumn {
    std::string text;         // without escape sequences
    std::size_t width;        // in characters, at least 1
    std::string colour = {};  // an escape sequence; empty: none
};

// Each column wrapped to its width, two blanks between them; lines end without blanks, the last with a line break.
std::string side_by_side(const std::vector<TextColumn>& columns);

}  // namespace analysis
