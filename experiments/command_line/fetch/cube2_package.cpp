#include "experiments/command_line/body_verbs.cpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/child_process.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/character/named_bodies.hpp"
#include "pbs/geometry/input_error.hpp"

#include <unistd.h>

namespace experiments {
namespace {

std::string install()
{
    const std::string by_hand = "as root: apt-get install --no-install-recommends cube2-data";
    std::vector<std::string> program = {"apt-get", "install", "-y", "-qq", "--no-install-recommends", "cube2-data"};
    const analysis::ScratchFolder scratch;
    if (::geteuid() != 0) {
        if (!run_program({"sudo", "-n", "true"}, scratch.path()).succeeded())
            throw pbs::InputError("", 0, "cube2-data", "", "this process is not root, and sudo asks for a password; " + by_hand);
        program.insert(program.begin(), {"sudo", "-n"});
    }
    const ProgramRun run = run_program(program, scratch.path());
    if (!run.started) throw pbs::InputError("", 0, "cube2-data", "", "apt-get is not installed: get Debian's package by other means");
    if (!run.succeeded()) throw pbs::InputError("", 0, "cube2-data", "", "apt-get failed (" + run.last_words + "); " + by_hand);
    pbs::require_body("frankie");
    return pbs::frankie_file();
}

}  // namespace

FetchedPackage cube2_package()
{
    return {.name = "Debian cube2-data",
            .bodies = {"frankie"},
            .licence =
                "Frankie of Yo Frankie!, by John 'geartrooper' Siar, Gregor Koch and the Apricot project (Blender Foundation), "
                "CC-BY 3.0",
            .is_installed = [] { return pbs::body_is_installed("frankie"); },
            .bring = install};
}

}  // namespace experiments
