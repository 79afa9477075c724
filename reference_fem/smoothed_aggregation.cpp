#include "reference_fem/smoothed_aggregation.hpp"

#include <ml_MultiLevelPreconditioner.h>

namespace reference_fem {

Teuchos::ParameterList smoothed_aggregation(double* modes, int number_of_modes, int block_size)
{
    Teuchos::ParameterList parameters;
    ML_Epetra::SetDefaults("SA", parameters);
    parameters.set("ML output", 0);
    parameters.set("initialize random seed", true);  // the estimate of the largest eigenvalue repeats to the bit
    parameters.set("PDE equations", block_size);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", number_of_modes);
    parameters.set("null space: vectors", modes);
    parameters.set("aggregation: type", "Uncoupled");  // no aggregate spans two ranks
    parameters.set("aggregation: threshold", 0.0);
    parameters.set("smoother: type", "Chebyshev");  // symmetric, and the same on any number of ranks
    parameters.set("smoother: sweeps", 2);
    parameters.set("smoother: Chebyshev alpha", 10.0);
    parameters.set("coarse: type", "Amesos-KLU");
    parameters.set("coarse: max size", 2000);
    return parameters;
}

}  // namespace reference_fem
