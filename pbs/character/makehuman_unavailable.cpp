#include "pbs/character/makehuman.hpp"
#include "pbs/geometry/input_error.hpp"

namespace pbs {
namespace {

constexpr const char* rule = "left out of this build (PBS_WITH_RIG_IMPORT is off)";

}  // namespace

std::string makehuman_folder()
{
    return {};
}

MakehumanFiles makehuman_files(const std::string&)
{
    return {};
}

void require_makehuman(const std::string& name)
{
    throw InputError("", 0, "character.body", name, rule);
}

Character make_makehuman(const std::string& name, int, bool)
{
    throw InputError("", 0, "character.body", name, rule);
}

}  // namespace pbs
