// pbskin compare A B [--part] [--json FILE] [--junit FILE]: compares two folders of results, number by number.

#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/reproduce/comparison.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <vector>

namespace experiments {
namespace {

struct CompareArguments {
    ComparedFolders folders;
    std::string json, junit;
};

// The records and tables below a folder. None of them may be an output.
std::vector<std::string> files_compared_in(const std::string& folder)
{
    std::vector<std::string> files;
    std::error_code unreadable;  // which compare_results refuses
    for (std::filesystem::recursive_directory_iterator file(folder, unreadable), end; file != end;
         file.increment(unreadable))
        if (const auto name = file->path().filename();
            name.extension() == ".csv" || name == "run.json" || name == "claims.md")
            files.push_back(file->path().string());
    return files;
}

int compare(const CompareArguments& arguments, const CommonOptions& common)
{
    for (const std::string& file : {arguments.json, arguments.junit})
        if (!file.empty()) analysis::require_writable(file);
    std::vector<std::string> inputs = files_compared_in(arguments.folders.first);
    std::ranges::move(files_compared_in(arguments.folders.second), std::back_inserter(inputs));
    analysis::require_separate({{"--json", arguments.json}, {"--junit", arguments.junit}}, inputs);
    const ResultComparison compared = compare_results(arguments.folders);
    if (!common.quiet) fmt::print("{}", comparison_text(compared, common.verbose ? 1000 : 12));
    if (!arguments.json.empty())
        analysis::write_text_atomically(arguments.json, analysis::record_text(to_json(compared)));
    if (!arguments.junit.empty())
        analysis::write_text_atomically(arguments.junit, analysis::junit_report(suites_of(compared)));
    return compared.agrees() ? exit_finished : exit_bound;
}

}  // namespace

void add_compare_verb(CommandLine& line)
{
    auto arguments = std::make_shared<CompareArguments>();
    CLI::App* verb = line.add("compare", "compares two folders of results; exit 1 if a number differs",
                              "pbskin compare results/before results/after",
                              [&common = line.common, arguments] { return compare(*arguments, common); });
    verb->add_option("A", arguments->folders.first, "what `run` or `reproduce` wrote, or kept records")->required();
    verb->add_option("B", arguments->folders.second, "the other one")->required();
    verb->add_flag("--part", arguments->folders.second_is_part, "B is a part of A: what only A has is no difference");
    verb->add_option("--json", arguments->json, "write all differences there, for programs")->type_name("FILE");
    verb->add_option("--junit", arguments->junit, "write a JUnit report with one test case per table")
        ->type_name("FILE");
}

}  // namespace experiments
