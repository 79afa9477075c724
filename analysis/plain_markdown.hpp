// Markdown as plain text for a terminal.
//   fmt::print("{}", plain_text(page, terminal_width()));
#pragma once

#include <cstddef>
#include <string>

namespace analysis {

// Headings, paragraphs, lists and tables within `width` characters. Only the text of a link is kept, and comments are left out. Lines of
// code keep their blanks unless they are too long.
std::string plain_text(const std::string& markdown, std::size_t width);

std::string first_paragraph(const std::string& markdown);  // the one below the title, on one line

}  // namespace analysis
