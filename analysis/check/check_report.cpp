#include "analysis/check/check.hpp"

#include "analysis/records/report_table.hpp"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <sstream>

namespace analysis {

int count(const std::vector<CheckSuite>& suites, CheckState state)
{
    int cases = 0;
    for (const CheckSuite& suite : suites)
        cases += static_cast<int>(std::count_if(suite.cases.begin(), suite.cases.end(),
                                                [&](const CheckCase& check) { return check.state == state; }));
    return cases;
}

const char* to_string(CheckState state)
{
    constexpr const char* names[] = {"holds", "FAILS", "left out", "BREAKDOWN", "REFUSED"};
    return names[static_cast<int>(state)];
}

std::string check_table(const std::vector<CheckSuite>& suites)
{
    std::string text;
    for (const CheckSuite& suite : suites) {
        text += fmt::format("{} ({:.1f} s)\n", suite.name, suite.seconds);
        for (const CheckCase& check : suite.cases)
            text += fmt::format("  {:<9}  {:<44}  {}\n", to_string(check.state), check.name, check.message);
        for (const auto& [name, value] : suite.properties)
            text += fmt::format("  {:<9}  {:<44}  {}\n", "", name, value);
    }
    return text;
}

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

void set(pugi::xml_node node, const char* name, const std::string& value)
{
    node.append_attribute(name) = value.c_str();
}

void set_counts(pugi::xml_node node, const std::vector<CheckSuite>& suites)
{
    std::size_t tests = 0;
    double seconds = 0.0;
    for (const CheckSuite& suite : suites) {
        tests += suite.cases.size();
        seconds += suite.seconds;
    }
    set(node, "tests", std::to_string(tests));
    set(node, "failures", std::to_string(count(suites, CheckState::failed)));
    set(node, "errors", std::to_string(count(suites, CheckState::broke_down) + count(suites, CheckState::refused)));
    set(node, "skipped", std::to_string(count(suites, CheckState::left_out)));
    set(node, "time", fmt::format("{:.3f}", seconds));
}

void add_case(pugi::xml_node parent, const CheckCase& check)
{
    pugi::xml_node node = parent.append_child("testcase");
    set(node, "classname", check.suite);
    set(node, "name", check.name);
    set(node, "time", fmt::format("{:.3f}", check.seconds));
    if (!check.file.empty()) set(node, "file", check.file);
    if (check.line > 0) set(node, "line", std::to_string(check.line));
    if (check.state == CheckState::held) {
        if (!check.message.empty()) node.append_child("system-out").text() = check.message.c_str();
        return;
    }
    const bool left_out = check.state == CheckState::left_out;
    pugi::xml_node outcome = node.append_child(left_out                            ? "skipped"
                                               : check.state == CheckState::failed ? "failure"
                                                                                   : "error");
    set(outcome, "message", check.message);
    if (!left_out) outcome.text() = check.message.c_str();
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
        "### pbskin: {} hold, {} fail, {} left out\n\n| | scene | bound | measured |\n|---|---|---|---|\n",
        count(suites, CheckState::held),
        count(suites, CheckState::failed) + count(suites, CheckState::broke_down) + count(suites, CheckState::refused),
        count(suites, CheckState::left_out));
    for (const CheckSuite& suite : suites) {
        for (const CheckCase& check : suite.cases)
            text += fmt::format("| {} | {} | {} | {} |\n", to_string(check.state), markdown_cell(suite.name),
                                markdown_cell(check.name), markdown_cell(check.message));
        for (const auto& [name, value] : suite.properties)
            text += fmt::format("| | {} | {} | {} |\n", markdown_cell(suite.name), markdown_cell(name),
                                markdown_cell(value));
    }
    return text + "\n";
}

std::string junit_report(const std::vector<CheckSuite>& suites)
{
    pugi::xml_document document;
    pugi::xml_node declaration = document.append_child(pugi::node_declaration);
    set(declaration, "version", "1.0");
    set(declaration, "encoding", "UTF-8");
    pugi::xml_node root = document.append_child("testsuites");
    set(root, "name", "pbskin");
    set_counts(root, suites);
    for (const CheckSuite& suite : suites) {
        pugi::xml_node node = root.append_child("testsuite");
        set(node, "name", suite.name);
        set_counts(node, {suite});
        pugi::xml_node properties = suite.properties.empty() ? pugi::xml_node() : node.append_child("properties");
        for (const auto& [name, value] : suite.properties) {
            pugi::xml_node property = properties.append_child("property");
            set(property, "name", name);
            set(property, "value", value);
        }
        for (const CheckCase& check : suite.cases) add_case(node, check);
    }
    std::ostringstream text;
    document.save(text, "  ");
    return text.str();
}

}  // namespace analysis
