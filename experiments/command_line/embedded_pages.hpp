// The pages that the program carries: the README.md of every study and the page of every claim, written in Markdown.
//   fmt::print("{}", plain_text(page_of("volume")));
#pragma once

#include <string>

namespace experiments {

// A study by its name or a claim by its id; std::out_of_range where there is no such page.
const std::string& page_of(const std::string& name);

std::string first_paragraph(const std::string& markdown);  // below the title, on one line

// For a terminal: without comments, and with links as their text alone. Tables and headings stay as they are.
std::string plain_text(const std::string& markdown);

}  // namespace experiments
