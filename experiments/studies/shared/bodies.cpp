#include "experiments/studies/shared/bodies.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>

namespace experiments {

namespace {

LoadedBody loaded(const std::string& name, const std::string& load, const pbs::TetMesh& mesh)
{
    LoadedBody body;
    body.name = name;
    body.load = load;
    body.mesh = mesh;
    body.mass_kg = flesh_density_kg_m3 * pbs::lumped_volumes(mesh.rest, mesh.tets);
    body.edges = static_cast<int>(pbs::edges_of(mesh.tets).rows());
    return body;
}

// Vertices of the tets that lie entirely in the held end.
std::vector<bool> held_end(const pbs::TetMesh& bar)
{
    const double first = bar.rest.col(0).minCoeff(), last = first + held_share * (bar.rest.col(0).maxCoeff() - first);
    std::vector<bool> held(bar.rest.rows(), false);
    for (const auto& tet : bar.tets.rowwise()) {
        if (!std::all_of(tet.begin(), tet.end(), [&](int v) { return bar.rest(v, 0) <= last; })) continue;
        for (const int v : tet) held[v] = true;
    }
    return held;
}

std::vector<bool> opposite(std::vector<bool> flags)
{
    flags.flip();
    return flags;
}

}  // namespace

LoadedBody jiggling_flesh(const pbs::Character& character, RestOfBody rest)
{
    const bool is_held = rest == RestOfBody::held;
    LoadedBody body = loaded(character.name, is_held ? "zone_on_held" : "zone", character.mesh);
    body.bind_distance = character.binding.distance;
    body.bind_point = character.binding.rest_point;
    body.zone = pbs::jiggle_zone(character.binding);
    body.held = is_held ? opposite(body.zone) : std::vector<bool>(body.zone.size(), false);
    body.direction = -pbs::Vec3::UnitY();
    return body;
}

LoadedBody hanging_bar(const pbs::TetMesh& bar)
{
    LoadedBody body = loaded("bar", "cantilever", bar);
    body.held = held_end(bar);
    body.zone = opposite(body.held);
    body.direction = -pbs::Vec3::UnitZ();
    return body;
}

double mean_displacement_m(const LoadedBody& body, const pbs::Positions& displacement)
{
    double moment = 0.0, mass_kg = 0.0;
    for (std::size_t v = 0; v < body.zone.size(); ++v) {
        if (!body.zone[v]) continue;
        moment += body.mass_kg(v) * displacement.row(v).dot(body.direction);
        mass_kg += body.mass_kg(v);
    }
    return moment / mass_kg;
}

double weight_n(const LoadedBody& body, double gravity_m_s2)
{
    double mass_kg = 0.0;
    for (std::size_t v = 0; v < body.zone.size(); ++v)
        if (body.zone[v]) mass_kg += body.mass_kg(v);
    return mass_kg * gravity_m_s2;
}

double effective_stiffness_n_m(const LoadedBody& body, const pbs::Positions& displacement, double gravity_m_s2)
{
    return weight_n(body, gravity_m_s2) / mean_displacement_m(body, displacement);
}

const std::array<TableOneRow, 5>& table_1()
{
    static const std::array<TableOneRow, 5> rows = {{{"Man", 1654, 6342, 4998, 1654, 33.0, 46.0, 52.0, 0.9, 90.5},
                                                     {"ManHQ", 2645, 13223, 10516, 2645, 74.2, 69.5, 72.1, 0.9, 71.1},
                                                     {"bunny", 2108, 9732, 7827, 2108, 63.3, 65.1, 68.3, 0.6, 76.8},
                                                     {"bunnyHQ", 3190, 17367, 14022, 3190, 83.5, 73.5, 76.4, 0.6, 65.8},
                                                     {"Lady", 1829, 9387, 6032, 1829, 57.2, 61.2, 64.5, 0.7, 79.5}}};
    return rows;
}

}  // namespace experiments
