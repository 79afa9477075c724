// The figures of C04 and C05 from the sections of all deformers: the narrowest and the widest near a joint, with the spread over meshes,
// orders and the reference's element orders.
#pragma once

#include "analysis/measurement.hpp"
#include "experiments/artefacts/artefact_case.hpp"

namespace experiments {

// of a figure: "limb, twist 90 deg, upper|forearm". Nothing is said of a group without samples.
std::vector<analysis::Measurement> candy_wrapper_figures(const ArtefactCase& of, const ArtefactBody& body,
                                                         const std::vector<ArtefactSample>& samples);
std::vector<analysis::Measurement> bulge_figures(const ArtefactCase& of, const ArtefactBody& body,
                                                 const std::vector<ArtefactSample>& samples);

}  // namespace experiments
