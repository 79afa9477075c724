// A record as it goes to disk: JSON in UTF-8, whatever names came in from outside.
//   analysis::write_text_atomically(path, record_text(run));
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace analysis {

// Bytes that are not UTF-8 become U+FFFD: a record is never lost over a name.
std::string record_text(const nlohmann::json& record);

bool is_utf8(const std::string& text);

}  // namespace analysis
