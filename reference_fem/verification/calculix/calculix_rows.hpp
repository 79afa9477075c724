// CalculiX's answers to the same nodes, tets and data as rows of the record. Its elements C3D4 and C3D10 are P1 and P2, so both programs
// solve one and the same system, and what differs is rounding or an error of one of them.
//
//   cantilever  #|=====================| |    weight and end load, linear
//               #|=====================| v
#pragma once

#include "reference_fem/verification/calculix/second_opinion.hpp"
#include "reference_fem/verification/common.hpp"

namespace reference_fem {

inline constexpr ElasticMaterial calculix_flesh{.young_pa = 1e5, .poisson = 0.3};

struct CalculixComparison {
    const Effort& effort;
    std::string program, version;
};

// The largest difference of a node's displacement, relative to the largest displacement, in a pose that is described in words. Mesh and
// cell size are left to the caller.
VerificationRow calculix_row(const CalculixComparison& comparison, const std::string& pose, const std::string& law, AnsweredProblem answer,
                             const DeckOptions& options);

VerificationRows calculix_cantilever_rows(const CalculixComparison& comparison);  // P1 and P2
VerificationRows calculix_timing_rows(const CalculixComparison& comparison);      // of the first solve

}  // namespace reference_fem
