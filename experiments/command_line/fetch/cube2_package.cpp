#include "experiments/command_line/fetch/cube2_package.hpp"

#include "analysis/records/scratch_folder.hpp"
#include "experiments/process/program_run.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/character/frankie.hpp"
#include "pbs/geometry/input_error.hpp"

#include <unistd.h>

namespace experiments {

bool cube2_is_there()
{
    return pbs::body_is_installed("frankie");
}

std::string bring_cube2()
{
    const std::string by_hand = "as root: apt-get install --no-install-recommends cube2-data";
    std::vector<std::string> install = {"apt-get", "install", "-y", "-qq", "--no-install-recommends", "cube2-data"};
    const analysis::ScratchFolder scratch;
    if (::geteuid() != 0) {
        if (!run_program({"sudo", "-n", "true"}, scratch.path()).succeeded())
            throw pbs::InputError("", 0, "cube2-data", "", "not root, and sudo wants a password; " + by_hand);
        install.insert(install.begin(), {"sudo", "-n"});
    }
    const ProgramRun run = run_program(install, scratch.path());
    if (!run.started) throw pbs::InputError("", 0, "cube2-data", "", "no apt-get on this machine: get Debian's package by other means");
    if (!run.succeeded()) throw pbs::InputError("", 0, "cube2-data", "", "apt-get failed (" + run.last_words + "); " + by_hand);
    pbs::require_body("frankie");
    return pbs::frankie_file();
}

}  // namespace experiments
