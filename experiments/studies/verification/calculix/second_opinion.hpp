// What CalculiX says of a problem that the judge has solved, node by node.
//   const SecondOpinion opinion = second_opinion(*calculix_on_path(), answered_cantilever(mesh, 1, {}));
#pragma once

#include "experiments/studies/verification/calculix/calculix_deck.hpp"
#include "experiments/studies/verification/calculix/calculix_run.hpp"

namespace experiments {

struct SecondOpinion {
    CalculixOutcome outcome = CalculixOutcome::not_started;  // finished: the figures below are there
    std::string last_words;                                  // what CalculiX said, where it did not finish
    double wall_s = 0.0;
    bool in_double = false;               // its displacements were read in double; false: 7 digits
    double largest_displacement_m = 0.0;  // the judge's
    double largest_difference_m = 0.0;    // of a node's displacement vector
    int node = -1;                        // where

    double relative_difference() const { return largest_difference_m / largest_displacement_m; }
};

// What CalculiX wrote is a pbs::InputError where it is damaged.
SecondOpinion second_opinion(const std::string& program, const AnsweredProblem& ours, const DeckOptions& options = {},
                             const CalculixLimits& limits = {});

}  // namespace experiments
