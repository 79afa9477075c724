#include "pbs/flesh/held_flesh.hpp"

#include "pbs/flesh/flesh_system.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/module.hpp"

#include <algorithm>
#include <numeric>
#include <string>

namespace pbs {
namespace {

// The function of the module pbskin_cholmod: fills in the factor, or leaves it empty if the matrix is not positive definite.
using FactorFunction = void(const Eigen::SparseMatrix<double>& lower, CholeskyFactor& factor);

constexpr double negligible = 1e-3;

// One column per bone, #V x #bones.
Eigen::MatrixXd relaxed(const Eigen::MatrixXd& pulls, const CholeskyFactor& factor)
{
    const int vertices = static_cast<int>(pulls.rows()), bones = static_cast<int>(pulls.cols());
    std::vector<int> place(vertices);
    std::iota(place.begin(), place.end(), 0);
    Eigen::MatrixXd weights(vertices, bones);
    Rows<double> rows(vertices);
    std::vector<double> work;
    for (int first = 0; first < bones; first += 3) {
        const int count = std::min(3, bones - first);
        for (int i = 0; i < vertices; ++i)
            for (int k = 0; k < count; ++k) rows[i][k] = pulls(i, first + k);
        solve_plainly(factor, place, rows.data(), work);
        for (int i = 0; i < vertices; ++i)
            for (int k = 0; k < count; ++k) weights(i, first + k) = rows[i][k];
    }
    return weights;
}

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
    const Eigen::MatrixXd weights = relaxed(hold_.stiffness_of_bones(), factor_);
    Weights smooth;
    smooth.first.push_back(0);
    for (Eigen::Index i = 0; i < weights.rows(); ++i) {
        const double sum = (weights.row(i).array() > negligible).select(weights.row(i), 0.0).sum();
        for (int bone = 0; bone < weights.cols(); ++bone) {
            if (!(weights(i, bone) > negligible)) continue;
            smooth.bone.push_back(bone);
            smooth.weight.push_back(weights(i, bone) / sum);
        }
        for (int k = otherwise.first[i]; sum == 0.0 && k < otherwise.first[i + 1]; ++k) {
            smooth.bone.push_back(otherwise.bone[k]);
            smooth.weight.push_back(otherwise.weight[k]);
        }
        smooth.first.push_back(static_cast<int>(smooth.bone.size()));
    }
    return smooth;
}

CholeskyFactor cholesky_factor(const Eigen::SparseMatrix<double>& lower)
{
    CholeskyFactor factor;
    load_module("pbskin_cholmod").function<FactorFunction>("pbskin_cholmod_factor")(lower, factor);
    return factor;
}

}  // namespace pbs
