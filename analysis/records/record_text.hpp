// A record as it is written to disk: JSON in UTF-8, whatever bytes the names in it contain.
//   analysis::write_text_atomically(path, record_text(run));
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace analysis {

// Bytes that are not UTF-8 become U+FFFD, so that a record is never lost because of a name.
std::string record_text(const nlohmann::json& record);

bool is_utf8(const std::string& text);

}  // namespace analysis
