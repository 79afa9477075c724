#include "pbs/character/human.hpp"

#include "pbs/character/body_cache.hpp"
#include "pbs/character/skeleton_file.hpp"
#include "pbs/character/surface_body.hpp"
#include "pbs/geometry/input_error.hpp"

#include "generated/pbs_data_texts.hpp"

#include <filesystem>

namespace pbs {
namespace {

constexpr const char* surface_file = "/usr/share/assimp/models/Collada/human.zae";
constexpr const char* geometry = "human-base";
constexpr int default_vertices = 2400;

}  // namespace

Skeleton human_skeleton()
{
    return parse_skeleton(pbs_data::human_skeleton_toml, "human.skeleton.toml");
}

void require_human()
{
    if (!std::filesystem::exists(surface_file))
        throw InputError("", 0, "character.body", "human", "not installed: needs the package assimp-testmodels");
}

Character make_human(int vertices, bool with_surface)
{
    require_human();
    const std::string surface_hash = hash_of_file(surface_file), skeleton_hash = content_hash(pbs_data::human_skeleton_toml);
    const SurfaceBody body{.name = "human", .made_from = surface_hash + skeleton_hash, .skeleton = human_skeleton(), .surface = [] {
                               return read_surface(surface_file, geometry);
                           }};
    Character human = make_surface_body(body, vertices > 0 ? vertices : default_vertices, with_surface);
    human.inputs = {{std::filesystem::path(surface_file).filename().string(), surface_hash}, {"human.skeleton.toml", skeleton_hash}};
    return human;
}

}  // namespace pbs
