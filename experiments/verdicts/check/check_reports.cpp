#include "experiments/verdicts/check/check_reports.hpp"

#include "analysis/check/check_report.hpp"
#include "analysis/records/record_files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <fstream>
#include <string_view>

namespace experiments {
namespace {

std::string_view environment(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

std::string place_of(const analysis::CheckCase& check)
{
    if (check.file.empty()) return "";
    return check.line > 0 ? fmt::format("{}:{}: ", check.file, check.line) : check.file + ": ";
}

bool is_for_github(const CheckReports& reports)
{
    return reports.github || environment("GITHUB_ACTIONS") == "true";
}

// GitHub's file, to which each step of a job adds its summary.
void add_to_summary(const std::string& text)
{
    const std::string summary(environment("GITHUB_STEP_SUMMARY"));
    if (summary.empty()) return;
    std::ofstream file(summary, std::ios::app);
    if (!(file << text << std::flush)) throw pbs::InputError(summary, 0, "GITHUB_STEP_SUMMARY", "", "cannot be written");
}

}  // namespace

void report_failures(const std::vector<analysis::CheckSuite>& suites)
{
    for (const analysis::CheckSuite& suite : suites)
        for (const analysis::CheckCase& check : suite.cases) {
            const std::string line = fmt::format("pbskin: {}{}: {}: {}", place_of(check), suite.name, check.name, check.message);
            if (check.state == analysis::CheckState::left_out)
                spdlog::warn("{}", line);
            else if (check.state != analysis::CheckState::held)
                spdlog::error("{}", line);
        }
}

void require_writable(const CheckReports& reports)
{
    if (!reports.junit.empty()) analysis::require_writable(reports.junit);
    if (is_for_github(reports)) add_to_summary("");
}

void write_reports(const CheckReports& reports, const std::vector<analysis::CheckSuite>& suites)
{
    if (!reports.junit.empty()) analysis::write_text_atomically(reports.junit, analysis::junit_report(suites));
    if (!is_for_github(reports)) return;
    fmt::print("{}", analysis::github_annotations(suites));
    add_to_summary(analysis::github_summary(suites));
}

}  // namespace experiments
