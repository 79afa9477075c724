#include "pbs/character/clip.hpp"
#include "pbs/geometry/input_error.hpp"

#include <filesystem>
#include <system_error>

namespace fs = std::filesystem;

namespace pbs {
namespace {

constexpr const char* installed_folder = "/usr/share/assimp/models/BVH";

}  // namespace

std::string find_clip(const std::string& name, const std::string& folder)
{
    std::error_code code;  // a name that is too long, or a loop of links, is no file either
    for (const fs::path& candidate : {fs::path(name), fs::path(folder) / name, fs::path(installed_folder) / name})
        if (fs::is_regular_file(candidate, code)) return candidate.string();
    throw InputError("", 0, "motion.clip", name,
                     "not found as it is, in '" + folder + "' or in " + installed_folder + " (package assimp-testmodels)");
}

}  // namespace pbs
