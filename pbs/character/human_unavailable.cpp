#include "pbs/character/human.hpp"
#include "pbs/geometry/input_error.hpp"

namespace pbs {
namespace {

constexpr const char* rule = "the human is left out of this build (PBS_WITH_RIG_IMPORT is off)";

}  // namespace

Skeleton human_skeleton()
{
    throw InputError("", 0, "character.body", "human", rule);
}

void require_human()
{
    throw InputError("", 0, "character.body", "human", rule);
}

Character make_human(int, bool)
{
    throw InputError("", 0, "character.body", "human", rule);
}

}  // namespace pbs
