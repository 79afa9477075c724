#include "pbs/flesh/held_flesh.hpp"

#include "pbs/flesh/cholmod_module.hpp"
#include "pbs/geometry/module.hpp"

namespace pbs {

CholeskyFactor cholesky_factor(const Eigen::SparseMatrix<double>& lower)
{
    CholeskyFactor factor;
    load_module("pbskin_cholmod").function<decltype(pbskin_cholmod_factor)>("pbskin_cholmod_factor")(lower, factor);
    return factor;
}

}  // namespace pbs
