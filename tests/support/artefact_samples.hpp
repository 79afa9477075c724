// A small limb that is bent, invented sections of it, and a twisted limb.
#pragma once

#include "experiments/studies/artefacts/artefact_values.hpp"
#include "tests/support/broken_solver.hpp"

#include <string>
#include <vector>

namespace test_support {

// In these of five steps.
inline experiments::ArtefactCase small_limb(experiments::ArtefactCase::Claim claim, int step_deg = 30,
                                            const std::vector<int>& frames = {1, 3, 5})
{
    experiments::ArtefactCase of;
    of.scene = experiments::read_scene(
        "limb_bend", {"character.vertices=400", "motion.angle_deg=" + std::to_string(5 * step_deg), "motion.frames=6"});
    of.claim = claim;
    for (const int frame : frames)
        of.poses.push_back({frame,
                            "bend " + std::to_string(step_deg * frame) + " deg",
                            {.motion = "bend", .angle_deg = double(step_deg * frame)}});
    return of;
}

// By LBS and PBS in the order of the file and double precision, which may be broken.
inline experiments::ArtefactCase twisted_limb(int vertices, const std::string& angle_deg, Broken how = Broken::nothing,
                                              const std::string& weights = "paper")
{
    experiments::ArtefactCase of;
    of.scene =
        broken(experiments::read_scene(
                   "limb_twist", {"character.vertices=" + std::to_string(vertices), "motion.angle_deg=" + angle_deg,
                                  "motion.frames=2", "reference.name=", "pbs.order=plain", "pbs.precision=f64",
                                  R"(deformers.use=["lbs", "pbs"])", "skinning.weights=\"" + weights + "\""}),
               how);
    of.claim = experiments::ArtefactCase::Claim::candy_wrapper;
    of.poses = {{1, "twist_" + angle_deg + "_deg"}};
    return of;
}

// Both radii have the ratio `size` to rest. PBS projects in the order of the file, in double precision, as claims
// select it.
inline experiments::ArtefactSample sample(const std::string& group, std::size_t pose, double size,
                                          int element_order = 0, const std::string& order = "plain")
{
    const bool is_pbs = group == "pbs";
    return {group, pose, 0, {size, size}, element_order, is_pbs ? order : "", is_pbs ? "f64" : ""};
}

}  // namespace test_support
