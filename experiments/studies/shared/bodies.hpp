// Bodies that hang under gravity, and the bodies of the paper's Table 1.
#pragma once

#include "experiments/characters/character.hpp"

#include <array>
#include <string>
#include <vector>

namespace experiments {

// A body that hangs under gravity from a part of it. Stiffnesses are measured on it, and give k a unit.
//   const LoadedBody body = jiggling_flesh(character, RestOfBody::held);
//   effective_stiffness_n_m(body, displacement, 9.81);
//
//   bone o=========o      ####------------------------+   a character's jiggling zone (Sec. 4), or the free
//        ~ ~ ~ ~ ~ ~      ####      bar, along x      |   length of a bar along x whose first tenth is held
//          | | | |  g     ####------------------------+   force = mass times gravity,
//                                                         stiffness = force over the mean displacement
inline constexpr double flesh_density_kg_m3 = 1000.0;
inline constexpr double held_share = 0.1;  // of a bar's length

// Outside the zone particles begin each step where LBS puts them. Projections move them (the paper's solver), or they
// are held there.
enum class RestOfBody { projected, held };

struct LoadedBody {
    std::string name;  // limb, human; bar
    std::string load;  // zone, zone_on_held, cantilever
    pbs::TetMesh mesh;
    Eigen::VectorXd bind_distance;  // [m], #V; empty: nothing is bound
    pbs::Positions bind_point;      // [m], #V x 3
    std::vector<bool> zone;         // loaded, and integrated in time, #V
    std::vector<bool> held;         // infinite mass, #V
    Eigen::VectorXd mass_kg;        // lumped, #V
    pbs::Vec3 direction;            // of gravity, unit
    int edges = 0;
};

LoadedBody jiggling_flesh(const pbs::Character& character, RestOfBody rest);
LoadedBody hanging_bar(const pbs::TetMesh& bar);  // tets that lie entirely in the first tenth are held

// Mean over the zone, weighted by mass, along gravity [m].
double mean_displacement_m(const LoadedBody& body, const pbs::Positions& displacement);

// Weight of the zone [N].
double weight_n(const LoadedBody& body, double gravity_m_s2);

// That weight over the zone's mean displacement [N/m]. With m_i = 1 gravity moves every particle alike, so the weight
// is that of the same flesh at `flesh_density_kg_m3`. It cancels in ratios of stiffnesses.
double effective_stiffness_n_m(const LoadedBody& body, const pbs::Positions& displacement, double gravity_m_s2);

// Table 1 of the paper.
struct TableOneRow {
    std::string model;
    int vertices, stretch, tets, bind;
    double stretch_ms, volume_ms, total_ms;  // "CT", for a simulation of 1 s
    double jiggling, frames_per_s;
};
const std::array<TableOneRow, 5>& table_1();

}  // namespace experiments
