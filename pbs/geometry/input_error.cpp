#include "pbs/geometry/input_error.hpp"

namespace pbs {
namespace {

std::string message(const std::string& file, int line, const std::string& field, const std::string& value, const std::string& rule)
{
    std::string text = file;
    if (line > 0) text.append(":").append(std::to_string(line));
    if (!text.empty()) text += ": ";
    if (!field.empty()) text += field;
    if (!value.empty()) text.append(" = ").append(value);
    if (!field.empty() || !value.empty()) text += ": ";
    return text + rule;
}

}  // namespace

InputError::InputError(const std::string& file, int line, const std::string& field, const std::string& value, const std::string& rule)
    : std::runtime_error(message(file, line, field, value, rule))
{
}

}  // namespace pbs
