// These functions remark on results that are doubtful: a deformer leaves out parts of the body, tets are inverted from
// the beginning, or the flesh carries the artist's surface badly.
//   remarks.add(remarks_on_set_up(scene, character, runners));
//   remarks.add(remarks_on_first_frame(scene, character, motion, runners, measurer));
#pragma once

#include "experiments/characters/remark.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/run/runners.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

// Bones without flesh, and slivers that a deformer took softer than they are.
pbs::RemarkList remarks_on_set_up(const Scene& scene, const pbs::Character& character,
                                  const std::vector<Runner>& runners);

// Inverted tets in the first frame of a model or a mesh, and deformers that go to each frame in steps from the bind
// pose. Built-in bodies are made with their skeleton.
pbs::RemarkList remarks_on_first_frame(const Scene& scene, const pbs::Character& character, const CaseMotion& motion,
                                       const std::vector<Runner>& runners, const FrameMeasurer& measurer);

// How well the tets carry the artist's surface. Parts that they weld together follow the wrong bone.
struct CarriedSkin {
    double largest_pct =
        0.0;  // the largest distance of the surface that LBS carries from the artist's, of the model's size at rest
    int frame = 0;
    std::string bone, bone_of_flesh;  // that carries the surface there, and that of the flesh
    double gap_m = 0.0, gap_pct = 0.0;
    bool at_a_joint = false;  // of the two bones
};
// followed.frame >= 0
CarriedSkin carried_skin(const pbs::Character& character, const RunFolder::FollowedSkin& followed);
void to_json(nlohmann::json& json, const CarriedSkin& skin);
pbs::RemarkList remarks_on(const CarriedSkin& skin, const std::string& scene_file);  // none where the two are close

}  // namespace experiments
