// pbskin references export [POSE]... -o DIR: the kept references in plain files.
//   pbskin references export limb_twist_60 -o kit

#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/references/export/reference_export.hpp"
#include "pbs/geometry/input_error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <string>
#include <vector>

namespace experiments {
namespace {

struct ExportArguments {
    std::string action, folder;
    std::vector<std::string> poses;
};

// A pose that cannot be exported is reported, and the others are exported.
int export_references(const ExportArguments& arguments)
{
    const auto [poses, left_out] = poses_to_export(arguments.poses);
    warn(left_out);
    if (poses.empty())
        throw pbs::InputError(std::filesystem::path(file_of_references("")).parent_path().string(), 0, "", "",
                              "has no reference of an installed body");
    ReferenceExport files(arguments.folder);
    bool all_exported = true;
    {
        Progress progress("exporting", static_cast<int>(poses.size()));
        for (const ReferencePose& pose : poses) {
            try {
                files.add(pose);
            } catch (const pbs::InputError& error) {
                spdlog::error("pbskin: {}", error.what());
                all_exported = false;
            }
            progress.advance_to(files.poses());
        }
    }
    if (files.poses() == 0) return exit_input;
    files.write_manual();
    if (!files.not_replaced().empty())
        warn({fmt::format(
            "{}: not replaced: differs from what this program writes (remove a file to have it written anew)",
            fmt::join(files.not_replaced(), ", "))});
    spdlog::info("poses: {}, bodies: {}, in {}", files.poses(), files.bodies(), arguments.folder);
    if (!all_exported) return exit_input;
    say_next("read " + analysis::path_in(arguments.folder, "README.md"));
    return exit_finished;
}

}  // namespace

void add_references_verb(CommandLine& line)
{
    auto arguments = std::make_shared<ExportArguments>();
    CLI::App* verb = line.add("references", "exports the solved references in plain files, for solvers of your own",
                              "pbskin references export limb_twist_60 -o kit",
                              [arguments] { return export_references(*arguments); });
    verb->add_option("action", arguments->action,
                     "export: write tets, bones, weights, springs, poses and references, with a manual")
        ->check(CLI::IsMember({"export"}))
        ->required();
    verb->add_option("poses", arguments->poses,
                     "which of them, e.g. limb_twist_60; by default all that are kept and whose body is installed");
    verb->add_option("-o,--output", arguments->folder, "folder of the files")->required();
}

}  // namespace experiments
