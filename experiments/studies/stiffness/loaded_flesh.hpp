// What an effective stiffness is measured on: part of a body hangs under gravity on the rest of it.
//   const LoadedFlesh flesh = jiggling_flesh(character, RestOfBody::held);
//   effective_stiffness_n_m(flesh, displacement, 9.81);
//
//   bone o=========o      a character's jiggling zone (Sec. 4), or the free length of a bar held at one end:
//        ~ ~ ~ ~ ~ ~      force = mass times gravity,  stiffness = force over the mean displacement along it
//          | | | |  g
#pragma once

#include "pbs/character/character.hpp"

#include <string>
#include <vector>

namespace experiments {

inline constexpr double flesh_density_kg_m3 = 1000.0;

// Outside the zone particles start each step where LBS puts them, and projections move them (the paper's solver), or they stay there.
enum class RestOfBody { projected, held };

struct LoadedFlesh {
    std::string name;  // limb, human; bar
    std::string load;  // zone, zone on held, cantilever
    pbs::TetMesh mesh;
    Eigen::VectorXd bind_distance;  // [m], #V; empty: nothing is bound
    pbs::Positions bind_point;      // [m], #V x 3
    std::vector<bool> zone;         // loaded, and integrated in time, #V
    std::vector<bool> held;         // infinite mass, #V
    Eigen::VectorXd mass_kg;        // lumped, #V
    pbs::Vec3 direction;            // of gravity, unit
    int edges = 0;
};

LoadedFlesh jiggling_flesh(const pbs::Character& character, RestOfBody rest);
LoadedFlesh hanging_bar(int vertices);

// Of the zone, weighted by mass, along gravity [m].
double mean_displacement_m(const LoadedFlesh& flesh, const pbs::Positions& displacement);

// Weight of the zone [N].
double weight_n(const LoadedFlesh& flesh, double gravity_m_s2);

// That weight over the zone's mean displacement [N/m]. With m_i = 1 gravity moves every particle alike, so the weight is that of the same
// flesh at `flesh_density_kg_m3`; in ratios of stiffnesses it cancels.
double effective_stiffness_n_m(const LoadedFlesh& flesh, const pbs::Positions& displacement, double gravity_m_s2);

}  // namespace experiments
