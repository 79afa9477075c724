// A character: its flesh, its bones, how these hang together, and the surface that is rendered. make_character
// (bodies.hpp) builds one.
//   const Character limb = make_character({.body = "limb"});
//   linear_blend_skinning(limb.mesh.rest, limb.weights, pose, posed);
#pragma once

#include "experiments/characters/embedding.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/weights.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pbs {

// The rule that weights come from: Eq. 2, the nearest bone alone, Eq. 2 with smooth transitions, Eq. 2 smoothed over
// the mesh's edges, Eq. 2 with the other reading of n_joints, the artist of a rigged file, a file of weights
// (skinning_weights.hpp).
enum class WeightKind { paper, rigid, smooth, diffused, either_end, artist, file };

struct RiggedModel;

// The skin of a rigged file, with the file itself.
struct ArtistSkin {
    // the artist's weights in the tets, #V; none of a file without joints
    Weights weights = {};
    std::shared_ptr<const RiggedModel> model = {};  // the file with its animations (model_character.hpp)
    double largest_distance_m = 0.0;                // from a vertex of the tets' boundary to the surface of the model
    bool is_cut =
        false;  // between parts that move apart, or joints have no flesh: only bones with a weight in flesh hold it
    // Points of the surface without flesh of their own, and the share by which joints carry them instead of the tets.
    std::vector<std::pair<int, double>> of_joints = {};
};

// make_character returns a whole one; whoever fills one in directly is responsible for matching sizes.
struct Character {
    std::string name;     // of the body, or of the mesh's file without its folder
    TetMesh mesh;         // flesh in rest pose [m]
    Skeleton skeleton;    // in rest pose [m], in the mesh's coordinates
    BoneBinding binding;  // of the mesh's vertices, #V
    Weights weights;      // what LBS and DQS blend with
    // vertices that Eq. 2 blends between bones, whatever `weights` is, #V
    std::vector<bool> blended;
    std::optional<EmbeddedSurface> surface;  // the surface people see, carried by the tets
    // of tets from a file: its number of each vertex, #V; empty: the same
    std::vector<int> file_vertex;
    int file_vertices = 0;             // of that file
    std::optional<ArtistSkin> artist;  // of a character from a rigged file
    // what it is made from, its clip with a run's -> content hash
    std::vector<std::pair<std::string, std::string>> inputs;
    WeightKind weight_kind = WeightKind::paper;  // the rule that `weights` obey, on finer tets too
    int refinements = 0;                         // how often its tets were cut into eight; see `refined`
    // whose bones' sizes it keeps, on finer or other tets; null: itself
    std::shared_ptr<const Character> unrefined;
    // the first of the bones that move as one with each bone, #bones; empty: each moves alone
    std::vector<int> moves_with;
};

// Vertices farther from their nearest bone than the mean over all (Sec. 4), #V.
std::vector<bool> jiggle_zone(const BoneBinding& binding);

// Another reading of it: farther than the mean over the vertices of their own bone, #V.
std::vector<bool> jiggle_zone_by_bone(const BoneBinding& binding);

// The nearest bone of each vertex; where the flesh is cut between parts, the nearest of those that move it: a jaw's
// bone does not hold the upper teeth.
BoneBinding nearest_bones(const Character& character);

// Fills in `binding` and `blended` by the mesh, the skeleton and the artist's skin.
void bind_by_paper(Character& character);

// The same character on finer tets: what any deformer is run on to learn how much its own mesh matters.
//   const Character fine = refined(character);   // its first #V vertices are those of `character`
// Skeleton and bones' sizes (Character::unrefined) stay; binding and weights follow the same rules on the finer mesh, a
// weights file's from the mean of the two vertices that a new one lies between; the rendered surface stays where it is.
// A rule that asks for the nearest bone jumps between vertices, so that a finer mesh shows Eq. 2's jumps more sharply:
// its limit is a jump. It has eight times the tets, and Character::refinements is one higher.
Character refined(const Character& character);

}  // namespace pbs
