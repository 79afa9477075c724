#include "pbs/character/json_file.hpp"

#include "pbs/character/body_cache.hpp"
#include "pbs/geometry/files.hpp"

#include <algorithm>

namespace pbs {
namespace {

int line_of(const std::string& text, std::size_t byte)
{
    return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size())), '\n'));
}

}  // namespace

JsonFile::JsonFile(const std::string& path) : path_(path)
{
    const std::string text = read_text_file(path);
    hash_ = content_hash(text);
    try {
        json_ = nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        throw InputError(path, line_of(text, error.byte), "", "", "no JSON, or cut short, at byte " + std::to_string(error.byte));
    }
}

const nlohmann::json& JsonFile::at(const nlohmann::json& part, const std::string& key) const
{
    if (!part.is_object() || !part.contains(key)) refuse(key, "missing");
    return part.at(key);
}

void JsonFile::refuse(const std::string& field, const std::string& rule) const
{
    throw InputError(path_, 0, field, "", rule);
}

}  // namespace pbs
