// toml++ ends the process on keys nested some ten thousand deep (a.a.a. ...) and, with assertions, on control characters and letters
// outside ASCII in bare words: TOML is looked through before it is parsed.
#pragma once

#include <string>

namespace pbs {

// An InputError that names the line where a key of the text has more than 64 parts or a bare word has other characters than ASCII.
void check_toml_keys(const std::string& text, const std::string& file);

}  // namespace pbs
