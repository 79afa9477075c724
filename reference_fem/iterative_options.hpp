// When conjugate gradients stop.
#pragma once

namespace reference_fem {

// Limits of each solve; the first of the two that is met ends it.
struct IterativeOptions {
    double tolerance = 1e-10;    // of the residual relative to the right-hand side
    int most_iterations = 1000;  // then it counts as not converged
};

}  // namespace reference_fem
