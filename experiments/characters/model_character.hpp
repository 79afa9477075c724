// A character from a rigged model: the tets fill its surface, its joints give the skeleton, the artist's weights are
// carried into the tets, and the tets carry the surface along.
//   RemarkList remarks;
//   const Character hero = make_model_character({.file = "hero.glb", .vertices = 2000}, remarks);
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/characters/remark.hpp"
#include "experiments/rigs/rigged_body.hpp"

#include <memory>
#include <string>
#include <vector>

namespace pbs {

// A rigged file as a character keeps it, for its animations and for the artist's own skinning.
struct RiggedModel {
    Rig rig;
    RiggedBody body;
    const RigAnimation* animation = nullptr;  // of `rig`; null: it has none
};

// A model file and the choices of how a character is made of it.
struct ModelSource {
    std::string file;
    std::string animation;   // by name; empty: the first one
    double scale = 1.0;      // further metres per metre of the file
    int vertices = 0;        // wanted of the tets; 0: default_model_vertices
    Skeleton skeleton = {};  // of a file without joints; of no use otherwise
};
constexpr int default_model_vertices = 2000;

// Reads a rigged file. animation: the name of the animation that determines the model's size; empty: the first one.
// scale: further metres per metre of the file. InputErrors are those of read_rig.
std::shared_ptr<const RiggedModel> read_model(const std::string& file, const std::string& animation, double scale);

// Binding and `weights` are left for make_character. `remarks` gets everything that was dropped, guessed or looks
// wrong. InputErrors are those of read_rig and mesh_surface, and a file without joints if there is no other skeleton.
Character make_model_character(const ModelSource& source, RemarkList& remarks);

// The rendered surface [m], #S x 3, from deformed tet vertices [m], #V x 3: carried by the tets, and by the joints in
// this pose where it has no flesh of its own (ArtistSkin::of_joints). The character has a surface.
Positions surface_positions(const Character& character, const Positions& positions, const Pose& pose);

// Remarks on a character from a rigged model: what the reader left out or corrected, and what is probably wrong: an
// unlikely size, a surface without volume or far from the tets, bones outside the body, joints without flesh. The
// character is made of the body and has its surface and its artist's weights.
RemarkList remarks_on_model(const RiggedBody& body, const Character& character, const std::string& file);

}  // namespace pbs
