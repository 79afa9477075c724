// Markdown as plain text for a terminal.
//   fmt::print("{}", plain_text(page_of("volume"), terminal_width()));
#pragma once

#include <cstddef>
#include <string>

namespace experiments {

// Headings, paragraphs, lists and tables within `width` characters; links as their text alone, comments left out. Lines of code keep their
// blanks unless they are too long.
std::string plain_text(const std::string& markdown, std::size_t width);

std::string first_paragraph(const std::string& markdown);  // below the title, on one line

}  // namespace experiments
