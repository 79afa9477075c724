// pbskin fetch [man, lady, frankie]: brings the bodies that are no part of the project onto this machine.
#include "experiments/command_line/fetch/packages.hpp"
#include "experiments/command_line/verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace experiments {
namespace {

int fetch(const std::vector<std::string>& bodies)
{
    for (const FetchedPackage& package : {makehuman_package(), cube2_package()}) {
        const auto is_wanted = [&](const std::string& body) { return std::count(bodies.begin(), bodies.end(), body) > 0; };
        if (!bodies.empty() && std::none_of(package.bodies.begin(), package.bodies.end(), is_wanted)) continue;
        fmt::print("{}: {}\n  {}\n", fmt::join(package.bodies, ", "), package.name, package.licence);
        if (package.is_installed()) {
            fmt::print("  is installed already\n");
            continue;
        }
        spdlog::info("fetching {} ...", package.name);
        fmt::print("  is now in {}\n", package.bring());
    }
    return exit_finished;
}

}  // namespace

void add_fetch_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb = add_verb(app, common, "fetch",
                              "brings the bodies that are no part of the project, by npm and apt; checks them and prints their licences");
    auto bodies = std::make_shared<std::vector<std::string>>();
    verb->add_option("bodies", *bodies, "which of them; by default all")->check(CLI::IsMember({"man", "lady", "frankie"}));
    verb->callback([&action, bodies] { action = [bodies] { return fetch(*bodies); }; });
}

}  // namespace experiments
