#include "analysis/check/github_report.hpp"

#include <fmt/format.h>

namespace analysis {
namespace {

// Escapes a text like GitHub's own toolkit does for workflow commands (actions/toolkit, command.ts).
std::string escaped(const std::string& text, bool is_property)
{
    std::string result;
    for (const char c : text) {
        const bool special = c == '%' || c == '\r' || c == '\n' || (is_property && (c == ':' || c == ','));
        result += special ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
    }
    return result;
}

std::string annotation(const CheckCase& check)
{
    std::string place;
    if (!check.file.empty()) place = fmt::format("file={},", escaped(check.file, true));
    if (check.line > 0) place += fmt::format("line={},", check.line);
    return fmt::format("::{} {}title={}::{}\n", check.state == CheckState::left_out ? "warning" : "error", place,
                       escaped(fmt::format("{} {}", check.suite, check.name), true), escaped(check.message, false));
}

std::string table_cell(std::string text)
{
    for (std::size_t at = 0; (at = text.find_first_of("|\n", at)) != std::string::npos; at += 2)
        text.replace(at, 1, text[at] == '|' ? "\\|" : "  ");
    return text;
}

}  // namespace

std::string github_annotations(const std::vector<CheckSuite>& suites)
{
    std::string text;
    for (const CheckSuite& suite : suites)
        for (const CheckCase& check : suite.cases)
            if (check.state != CheckState::held) text += annotation(check);
    return text;
}

std::string github_summary(const std::vector<CheckSuite>& suites)
{
    std::string text = fmt::format(
        "### pbskin: {} hold, {} fail, {} left out\n\n| | scene | bound | measured |\n|---|---|---|---|\n", count(suites, CheckState::held),
        count(suites, CheckState::failed) + count(suites, CheckState::broke_down) + count(suites, CheckState::refused),
        count(suites, CheckState::left_out));
    for (const CheckSuite& suite : suites) {
        for (const CheckCase& check : suite.cases)
            text += fmt::format("| {} | {} | {} | {} |\n", to_string(check.state), table_cell(suite.name), table_cell(check.name),
                                table_cell(check.message));
        for (const auto& [name, value] : suite.properties)
            text += fmt::format("| | {} | {} | {} |\n", table_cell(suite.name), table_cell(name), table_cell(value));
    }
    return text + "\n";
}

}  // namespace analysis
