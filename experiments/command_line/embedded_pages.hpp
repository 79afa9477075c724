// The pages that the program carries: the README.md of every study and the page of every claim, written in Markdown.
#pragma once

#include <string>

namespace experiments {

// A study by its name or a claim by its id; std::out_of_range where there is no such page.
const std::string& page_of(const std::string& name);

}  // namespace experiments
