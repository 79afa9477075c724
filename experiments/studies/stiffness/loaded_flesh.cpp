#include "experiments/studies/stiffness/loaded_flesh.hpp"

#include "experiments/studies/fit/cantilever.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "pbs/geometry/topology.hpp"

namespace experiments {
namespace {

LoadedFlesh loaded(const std::string& name, const std::string& load, const pbs::TetMesh& mesh)
{
    LoadedFlesh flesh;
    flesh.name = name;
    flesh.load = load;
    flesh.mesh = mesh;
    flesh.mass_kg = flesh_density_kg_m3 * pbs::lumped_volumes(mesh.rest, mesh.tets);
    flesh.edges = static_cast<int>(pbs::edges_of(mesh.tets).rows());
    return flesh;
}

std::vector<bool> opposite(std::vector<bool> flags)
{
    flags.flip();
    return flags;
}

}  // namespace

LoadedFlesh jiggling_flesh(const pbs::Character& character, RestOfBody rest)
{
    const bool is_held = rest == RestOfBody::held;
    LoadedFlesh flesh = loaded(character.name, is_held ? "zone on held" : "zone", character.mesh);
    flesh.bind_distance = character.binding.distance;
    flesh.bind_point = character.binding.rest_point;
    flesh.zone = pbs::jiggle_zone(character.binding);
    flesh.held = is_held ? opposite(flesh.zone) : std::vector<bool>(flesh.zone.size(), false);
    flesh.direction = -pbs::Vec3::UnitY();
    return flesh;
}

LoadedFlesh hanging_bar(int vertices)
{
    const Cantilever cantilever = make_cantilever(pbs::make_character({.body = "bar", .vertices = vertices}).mesh);
    LoadedFlesh flesh = loaded("bar", "cantilever", cantilever.character.mesh);
    flesh.held = cantilever.held;
    flesh.zone = opposite(cantilever.held);
    flesh.direction = -pbs::Vec3::UnitZ();
    return flesh;
}

double mean_displacement_m(const LoadedFlesh& flesh, const pbs::Positions& displacement)
{
    double moment = 0.0, mass_kg = 0.0;
    for (std::size_t v = 0; v < flesh.zone.size(); ++v) {
        if (!flesh.zone[v]) continue;
        moment += flesh.mass_kg(v) * displacement.row(v).dot(flesh.direction);
        mass_kg += flesh.mass_kg(v);
    }
    return moment / mass_kg;
}

double weight_n(const LoadedFlesh& flesh, double gravity_m_s2)
{
    double mass_kg = 0.0;
    for (std::size_t v = 0; v < flesh.zone.size(); ++v)
        if (flesh.zone[v]) mass_kg += flesh.mass_kg(v);
    return mass_kg * gravity_m_s2;
}

double effective_stiffness_n_m(const LoadedFlesh& flesh, const pbs::Positions& displacement, double gravity_m_s2)
{
    return weight_n(flesh, gravity_m_s2) / mean_displacement_m(flesh, displacement);
}

}  // namespace experiments
