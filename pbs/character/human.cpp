#include "pbs/character/human.hpp"

#include "pbs/character/body_cache.hpp"
#include "pbs/character/skeleton_file.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/meshing.hpp"

#include "generated/pbs_data_texts.hpp"

#include <filesystem>

namespace pbs {
namespace {

constexpr const char* surface_file = "/usr/share/assimp/models/Collada/human.zae";
constexpr const char* geometry = "human-base";
constexpr int default_vertices = 2400;
constexpr int mesher_version = 3;  // raised whenever mesh_surface makes something else of the same surface

SurfaceMeshing meshing_of(const Skeleton& skeleton, int vertices)
{
    SurfaceMeshing options;
    options.vertices = vertices;
    for (const Bone& bone : skeleton.bones) options.inside.push_back(bone.head);
    return options;
}

std::string key_of(const std::string& surface_hash, int vertices)
{
    const std::string made_from = surface_hash + content_hash(pbs_data::human_skeleton_toml) + std::to_string(mesher_version);
    return "human-" + std::to_string(vertices) + "-" + content_hash(made_from);
}

}  // namespace

Skeleton human_skeleton()
{
    return parse_skeleton(pbs_data::human_skeleton_toml, "human.skeleton.toml");
}

Character make_human(int vertices, bool with_surface)
{
    if (!std::filesystem::exists(surface_file))
        throw InputError("", 0, "character.body", "human", "not installed: needs the package assimp-testmodels");
    if (vertices <= 0) vertices = default_vertices;

    Character human;
    human.name = "human";
    human.skeleton = human_skeleton();
    const std::string surface_hash = hash_of_file(surface_file);
    human.mesh = cached_mesh(key_of(surface_hash, vertices),
                             [&] { return mesh_surface(read_surface(surface_file, geometry), meshing_of(human.skeleton, vertices)); });
    if (with_surface) {
        const SurfaceMesh surface = read_surface(surface_file, geometry);
        human.surface = embed(surface.points, surface.triangles, human.mesh);
    }
    human.inputs = {{std::filesystem::path(surface_file).filename().string(), surface_hash},
                    {"human.skeleton.toml", content_hash(pbs_data::human_skeleton_toml)}};
    return human;
}

}  // namespace pbs
