// The functions that need the readers of PBS_WITH_RIG_IMPORT, in a build without them.
#include "experiments/characters/named_bodies.hpp"
#include "experiments/characters/skeleton_file.hpp"
#include "pbs/geometry/input_error.hpp"

#define PBS_REFUSE(refusal, ...) \
    __VA_ARGS__                  \
    {                            \
        refusal;                 \
    }

namespace pbs {
namespace {

constexpr const char* left_out = "left out of this build (PBS_WITH_RIG_IMPORT is off)";

[[noreturn]] void refuse_body(const std::string& name)
{
    throw InputError("", 0, "character.body", name, (name == "human" ? std::string("the human is ") : "") + left_out);
}

[[noreturn]] void refuse_file(const std::string& path)
{
    throw InputError(path, 0, "", "", std::string("skeleton files are ") + left_out);
}

}  // namespace

PBS_REFUSE(refuse_file(name), Skeleton parse_skeleton(const std::string&, const std::string& name))
PBS_REFUSE(refuse_body("human"), Skeleton human_skeleton())
PBS_REFUSE(refuse_body(name), std::vector<std::string> human_files(const std::string& name))
PBS_REFUSE(refuse_body(name), Character make_human(const std::string& name, int, bool))
PBS_REFUSE(refuse_body(name), std::vector<std::string> figure_files(const std::string& name))
PBS_REFUSE(refuse_body(name), Character make_figure(const std::string& name, int, bool))

}  // namespace pbs
