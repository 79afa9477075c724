// The rules by which the vertices of a character get their skinning weights.
//   const Weights smooth = weights_by(WeightKind::diffused, character);
//   const Character rigid = with_weights(WeightKind::rigid, character);
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/characters/embedding.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/weights.hpp"

#include <array>
#include <functional>
#include <optional>
#include <string>

namespace pbs {

// Weights of the character's tets by a rule, #V. The rules artist and file return the weights that a rigged file or a
// weights file brought; InputError if the character has none. The rules smooth and diffused are controls for Eq. 2,
// whose weights jump from vertex to vertex. Smooth weights are those of Eq. 2 where it gives a vertex to one bone
// alone, and harmonic between; they still jump where two such vertices of different bones are neighbours. Diffused
// weights are those of Eq. 2, smoothed eight times over the mesh's edges (weights.hpp), so that they are smooth
// everywhere, over about two edges of the mesh. On the human in clip 01_01, LBS inverts 93 tets per frame with the
// weights of Eq. 2, 81 with smooth and 0.2 with diffused ones.
Weights weights_by(WeightKind kind, const Character& character);

// The character with weights by another rule; everything else is kept.
Character with_weights(WeightKind kind, Character character);

bool has_artist_weights(const Character& character);

// The names of the rules, in the order of WeightKind. A scene states the last one, file, by the path of the file.
inline constexpr std::array weight_names = {"paper", "rigid", "smooth", "diffused", "either_end", "artist", "file"};
inline const char* name_of(WeightKind kind)
{
    return weight_names[static_cast<std::size_t>(kind)];
}
std::optional<WeightKind> weights_named(const std::string& name);  // null for a file, and for every other name

// An artist's skin weights in the flesh.
struct TransferredWeights {
    Weights weights;                  // of the tets' vertices, #V
    double largest_distance_m = 0.0;  // from a vertex of the tets' boundary to the surface, without cuts
};

// A vertex on the boundary of the tets gets the weights of the surface's nearest point (linear in its triangle), a
// vertex inside their harmonic extension. surface [m], #S x 3; triangles #F x 3 with #F > 0; skin: weights of the
// surface's points, #S. Small weights (1e-6) are removed and the others normalised. may_move(vertex, point): only such
// points are taken, unless there is none for the vertex; by default all.
TransferredWeights transfer_weights(const TetMesh& mesh, const Positions& surface, const Triangles& triangles,
                                    const Weights& skin, int bones,
                                    const std::function<bool(Eigen::Index, const SurfacePoint&)>& may_move = {});

// How much of the artist's weights the tets carry: at a point of the surface, the lesser of the artist's weight of a
// bone and the one that the tets have there.
struct CarriedWeight {
    std::vector<double> of_artist, carried;  // sums over the points, #bones
    std::vector<double> at_point;            // the sum over the bones at each point of the surface, 0 to 1
    double share_pct() const;                // 100: the tets move every point as the artist does
};
CarriedWeight carried_weight(const Weights& skin, const Weights& in_tets, const EmbeddedSurface& surface,
                             const Tets& tets, int bones);

// Skinning weights from the text of a file, which `name` stands for in errors: CSV vertex,joint,weight. vertices: #V of
// the mesh. Zero weights are left out. InputError by line where the header vertex,joint,weight is missing; a row has
// not three fields, a vertex from 0 to #V - 1, a joint of the skeleton (the nearest is named) and a weight in [0, 1]; a
// vertex names a joint twice, has no weight, or its weights do not sum to one within 1e-6.
Weights parse_weights(const std::string& text, const std::string& name, const Skeleton& skeleton, int vertices);

// The same for tets of whose file vertices were left out or split: file_vertex is the file's number of each vertex, #V,
// below file_vertices. Only vertices that are in it need weights.
Weights parse_weights(const std::string& text, const std::string& name, const Skeleton& skeleton, int file_vertices,
                      const std::vector<int>& file_vertex);

}  // namespace pbs
