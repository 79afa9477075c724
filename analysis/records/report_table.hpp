// Text for a terminal: lines wrapped between words to a width, columns side by side, and Markdown as plain text.
//   fmt::print("{}", side_by_side({{"C02", 4}, {"reproduced in part", 14}, {statement, 40}}));
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace analysis {

// Lines of at most `width` characters (UTF-8 code points, not bytes). A longer word is broken, and line breaks in the
// text are kept.
std::vector<std::string> wrapped(const std::string& text, std::size_t width);

std::size_t characters(const std::string& text);  // number of code points of a UTF-8 text

// A cell of a row, which is wrapped if it is too wide.
struct TextColumn {
    std::string text;         // without escape sequences
    std::size_t width;        // in characters, at least 1
    std::string colour = {};  // an escape sequence; empty: none
};

// Each column is wrapped to its width, with two blanks between columns. Lines end without blanks, and the last one with
// a line break.
std::string side_by_side(const std::vector<TextColumn>& columns);

// Markdown as plain text for a terminal.
//   fmt::print("{}", plain_text(page, terminal_width()));
// Headings, paragraphs, lists and tables within `width` characters. Only the text of a link is kept; comments, pictures
// and the marks of code and emphasis are left out. Lines of code keep their blanks unless they are too long.
std::string plain_text(const std::string& markdown, std::size_t width);

// A cell of a Markdown table: one line, with vertical bars escaped.
std::string markdown_cell(std::string text);

std::string first_paragraph(const std::string& markdown);  // the one below the title, on one line, without marks

}  // namespace analysis
