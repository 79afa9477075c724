#include "pbs/flesh/held_flesh.hpp"

#include "pbs/flesh/flesh_system.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/module.hpp"

#include <string>

namespace pbs {
namespace {

// The function of the module pbskin_cholmod: fills in the factor, or leaves it empty if the matrix is not positive definite.
using FactorFunction = void(const Eigen::SparseMatrix<double>& lower, CholeskyFactor& factor);

}  // namespace

HeldFlesh::HeldFlesh(const TetMesh& mesh, const BoneSprings& springs, int bones, const HeldFleshOptions& options)
    : hold_(mesh, springs, bones), energy_(mesh, flesh_material(options.poisson), hold_)
{
    if (!(hold_.stiffness().sum() > 0.0))
        throw InputError("flesh", 0, "springs", std::to_string(springs.points.rows()), "expected one that lies inside the tets");
    factor_ = cholesky_factor(flesh_laplacian(mesh, flesh_material(options.poisson), energy_, options.volume_share));
    if (!factor_.usable())
        throw InputError("flesh", 0, "Laplacian", std::to_string(mesh.rest.rows()) + " vertices",
                         "expected tets whose Laplacian is positive definite in double; are some of them flat?");
}

Weights HeldFlesh::smooth_weights(const Weights& otherwise) const
{
    constexpr double negligible = 1e-3;
    return sparse_weights(solve_plainly(factor_, hold_.stiffness_of_bones()), negligible, otherwise);
}

CholeskyFactor cholesky_factor(const Eigen::SparseMatrix<double>& lower)
{
    CholeskyFactor factor;
    load_module("pbskin_cholmod").function<FactorFunction>("pbskin_cholmod_factor")(lower, factor);
    return factor;
}

}  // namespace pbs
