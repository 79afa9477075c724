#include "analysis/records/record_text.hpp"

#include <nlohmann/json.hpp>

namespace analysis {

std::string record_text(const nlohmann::json& record)
{
    return record.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

bool is_utf8(const std::string& text)
{
    try {
        return !nlohmann::json(text).dump().empty();
    } catch (const nlohmann::json::type_error&) {
        return false;
    }
}

}  // namespace analysis
