// When conjugate gradients stop.
#pragma once

namespace reference_fem {

struct IterativeOptions {
    double tolerance = 1e-10;  // of the residual relative to the right-hand side
    int most_iterations = 1000;
};

}  // namespace reference_fem
