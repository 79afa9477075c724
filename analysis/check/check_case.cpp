#include "analysis/check/check_case.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace analysis {

int count(const std::vector<CheckSuite>& suites, CheckState state)
{
    int found = 0;
    for (const CheckSuite& suite : suites)
        found += static_cast<int>(
            std::count_if(suite.cases.begin(), suite.cases.end(), [&](const CheckCase& check) { return check.state == state; }));
    return found;
}

const char* to_string(CheckState state)
{
    switch (state) {
        case CheckState::held:
            return "holds";
        case CheckState::failed:
            return "FAILS";
        case CheckState::left_out:
            return "left out";
        case CheckState::broke_down:
            return "BREAKDOWN";
        case CheckState::refused:
            return "REFUSED";
    }
    return "";
}

std::string check_table(const std::vector<CheckSuite>& suites)
{
    std::string text;
    for (const CheckSuite& suite : suites) {
        text += fmt::format("{} ({:.1f} s)\n", suite.name, suite.seconds);
        for (const CheckCase& check : suite.cases)
            text += fmt::format("  {:<9}  {:<44}  {}\n", to_string(check.state), check.name, check.message);
        for (const auto& [name, value] : suite.properties) text += fmt::format("  {:<9}  {:<44}  {}\n", "", name, value);
    }
    return text;
}

}  // namespace analysis
