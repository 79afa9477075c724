// CalculiX's answer to a problem that the reference has solved, compared node by node.
//   const SecondOpinion opinion = second_opinion(*calculix_on_path(), answered_cantilever(mesh, 1, {}));
#pragma once

#include "reference_fem/verification/calculix/calculix_deck.hpp"
#include "reference_fem/verification/calculix/calculix_run.hpp"

namespace reference_fem {

struct SecondOpinion {
    CalculixOutcome outcome = CalculixOutcome::not_started;  // finished: the numbers below are set
    std::string last_words;                                  // the end of CalculiX's output, where it did not finish
    double wall_s = 0.0;
    bool in_double = false;               // its displacements were read in double; false: 7 digits
    double largest_displacement_m = 0.0;  // the reference's
    double largest_difference_m = 0.0;    // of a node's displacement vector
    int node = -1;                        // where

    double relative_difference() const { return largest_difference_m / largest_displacement_m; }
};

// pbs::InputError where CalculiX's files are damaged.
SecondOpinion second_opinion(const std::string& program, const AnsweredProblem& ours, const DeckOptions& options = {},
                             const CalculixLimits& limits = {});

}  // namespace reference_fem
