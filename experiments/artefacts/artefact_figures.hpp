// The figures of C04 and C05 from the sections of all deformers: the narrowest and the widest near a joint, with the spread over meshes,
// orders and the reference's element orders.
#pragma once

#include "analysis/measurement.hpp"
#include "experiments/artefacts/artefact_case.hpp"

namespace experiments {

// of a figure: "limb, twist 90 deg, upper|forearm". Nothing is said of a group without samples.
std::vector<analysis::Measurement> candy_wrapper_figures(const ArtefactCase& of, const ArtefactBody& body,
                                                         const std::vector<ArtefactSample>& samples);
// Of poses that bend the joint by at most 110 degrees, that of rest included: beyond, the skin is folded so deeply into the joint that a
// section's outline may go round both halves of the limb, the reference's as well. The profiles have them all.
std::vector<analysis::Measurement> bulge_figures(const ArtefactCase& of, const ArtefactBody& body,
                                                 const std::vector<ArtefactSample>& samples);

}  // namespace experiments
