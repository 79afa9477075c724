// pbskin try MODEL --bake: correctives that are learned from the character's own reference, for scenes and for game
// engines.
//   // writes results/hero/frames/correctives.toml and correctives.glb
//   const nlohmann::json facts = bake_correctives(scene, "results/hero", options);
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/scene/scene.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace experiments {

struct BakeOptions {
    double seconds = 1e9;  // of processor time for frames that the trial has not solved, and again for the poses drawn
    double most_glb_bytes = 1e9;  // fewer modes per joint where the file would be larger, one at least
    bool surface_files = false;   // the surface in each frame as frames/correctives_surface_000123.vtp, too
};

// The weights by which a format for games moves the surface that the character carries: those of the artist, otherwise
// those of the tets that carry each point; the four heaviest bones of a point, scaled to a sum of one.
pbs::Weights surface_weights(const pbs::Character& character);

// Solves the reference of the scene in the frames of its motion, which a run in `folder` may have solved, and linear
// elements in 900 poses that are drawn around these frames (corrective_training.hpp; fewer for a surface of many
// points), and fits correctives to them, except for every third frame of the motion. Writes
//   frames/correctives.toml  the correctives of the tets, for the deformer of this name
//   frames/correctives.glb   the surface with its skin (surface_weights), the correctives of the surface as morph
//                            targets, and the motion. The surface is fitted by itself, so that targets and skin give
//                            its correctives exactly
// Facts: the number of poses that were `trained` and `held_out`, of `modes` of the tets, and of `targets` of the
// surface; `seconds`, wall time; and the distance of the skin from the reference in the frames held out, root mean
// square on a body of 1.7 m: `within` the range of the trained features and `beyond` it, each with `frames`, `lbs_mm`
// and `correctives_mm`, or null without such a frame. InputError where no pose was reached, and where a file cannot be
// written.
nlohmann::json bake_correctives(const Scene& scene, const std::string& folder, const BakeOptions& options);

}  // namespace experiments
