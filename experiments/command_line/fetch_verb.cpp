// pbskin fetch [man, lady, frankie]: the bodies that are not part of the project, onto this machine.
#include "experiments/command_line/verbs.hpp"
#include "experiments/command_line/fetch/packages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

namespace experiments {
namespace {

int fetch(const std::vector<std::string>& bodies)
{
    for (const FetchedPackage& package : packages_of(bodies)) {
        const std::string who = fmt::format("{}: {}", fmt::join(package.bodies, ", "), package.name);
        fmt::print("{}\n  {}\n", who, package.licence);
        if (package.is_there()) {
            fmt::print("  there already\n");
            continue;
        }
        spdlog::info("fetching {} ...", package.name);
        fmt::print("  now in {}\n", package.bring());
    }
    return exit_finished;
}

}  // namespace

void add_fetch_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb =
        add_verb(app, common, "fetch", "the bodies that are no part of the project: by npm and apt, checked; licences are told");
    auto bodies = std::make_shared<std::vector<std::string>>();
    verb->add_option("bodies", *bodies, "which of them; all by default")->check(CLI::IsMember({"man", "lady", "frankie"}));
    verb->callback([&action, bodies] { action = [bodies] { return fetch(*bodies); }; });
}

}  // namespace experiments
