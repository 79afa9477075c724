// A small limb bent by 30, 90 and 150 degrees, invented sections of it, and a twisted limb.
#pragma once

#include "experiments/studies/artefacts/artefact_values.hpp"
#include "tests/support/broken_solver.hpp"

namespace test_support {

inline experiments::ArtefactCase small_limb(experiments::ArtefactCase::Claim claim)
{
    experiments::ArtefactCase of;
    of.scene = experiments::read_scene("limb_bend", {"character.vertices=400", "motion.angle_deg=150", "motion.frames=6"});
    of.claim = claim;
    for (const int frame : {1, 3, 5})
        of.poses.push_back({frame, "bend " + std::to_string(30 * frame) + " deg", {.motion = "bend", .angle_deg = 30.0 * frame}});
    return of;
}

// By LBS and PBS, which may be broken.
inline experiments::ArtefactCase twisted_limb(int vertices, const std::string& angle_deg, Broken how = Broken::nothing,
                                              const std::string& weights = "paper")
{
    experiments::ArtefactCase of;
    of.scene =
        broken(experiments::read_scene(
                   "limb_twist", {"character.vertices=" + std::to_string(vertices), "motion.angle_deg=" + angle_deg, "motion.frames=2",
                                  "reference.name=", R"(deformers.use=["lbs", "pbs"])", "skinning.weights=\"" + weights + "\""}),
               how);
    of.claim = experiments::ArtefactCase::Claim::candy_wrapper;
    of.poses = {{1, "twist_" + angle_deg + "_deg"}};
    return of;
}

// Both radii and both areas have the ratio `size` to rest.
inline experiments::ArtefactSample sample(const std::string& group, std::size_t pose, double size, int element_order = 0)
{
    return {group, pose, 0, {size, size, size, size}, element_order};
}

}  // namespace test_support
