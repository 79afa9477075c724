#include "pbs/character/surface_body.hpp"

#include "pbs/character/body_cache.hpp"
#include "pbs/geometry/meshing.hpp"

namespace pbs {
namespace {

constexpr int mesher_version = 3;  // raised whenever mesh_surface makes something else of the same surface

SurfaceMeshing meshing_of(const SurfaceBody& body, int vertices)
{
    SurfaceMeshing options;
    options.vertices = vertices;
    if (body.is_foreign) {
        options.boundary_euler.reset();
        options.is_closed = options.is_one_piece = false;
        return options;
    }
    options.boundary_euler = body.boundary_euler;
    options.inside = body.inside;
    if (options.inside.empty())
        for (const Bone& bone : body.skeleton.bones) options.inside.push_back(bone.head);
    return options;
}

}  // namespace

Character make_surface_body(const SurfaceBody& body, int vertices, bool with_surface)
{
    Character character;
    character.name = body.name;
    character.skeleton = body.skeleton;
    const std::string key =
        body.name + "-" + std::to_string(vertices) + "-" + content_hash(body.made_from + std::to_string(mesher_version));
    character.mesh = cached_mesh(key, [&] { return mesh_surface(body.surface(), meshing_of(body, vertices)); });
    if (with_surface) {
        const SurfaceMesh surface = body.surface();
        character.surface = embed(surface.points, surface.triangles, character.mesh);
    }
    return character;
}

}  // namespace pbs
