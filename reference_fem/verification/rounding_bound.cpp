#include "reference_fem/verification/rounding_bound.hpp"

#include "reference_fem/linear_flesh.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace reference_fem {
namespace {

constexpr int most_steps = 60;

SparseMatrix free_block(const SparseMatrix& matrix, const std::vector<bool>& prescribed)
{
    std::vector<int> place(prescribed.size());
    int unknowns = 0;
    for (std::size_t i = 0; i < prescribed.size(); ++i) place[i] = prescribed[i] ? -1 : unknowns++;
    std::vector<Eigen::Triplet<double, SparseMatrix::StorageIndex>> entries;
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column)
        for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
            if (place[entry.row()] >= 0 && place[column] >= 0) entries.emplace_back(place[entry.row()], place[column], entry.value());
    SparseMatrix block(unknowns, unknowns);
    block.setFromTriplets(entries.begin(), entries.end());
    return block;
}

// The largest magnitude of an eigenvalue of a symmetric operator on R^n: C. Lanczos, J. Res. Nat. Bur. Stand. 45, 1950, with every vector
// made orthogonal to all before it, twice.
double largest_eigenvalue(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& apply, Eigen::Index n)
{
    const Eigen::Index steps = std::min<Eigen::Index>(most_steps, n);
    Eigen::MatrixXd basis(n, steps);
    Eigen::VectorXd diagonal(steps), beside(steps);
    std::mt19937 random(1);
    Eigen::VectorXd next = Eigen::VectorXd::NullaryExpr(n, [&] { return random() / 4294967295.0 - 0.5; });
    Eigen::Index taken = 0;
    for (bool exhausted = false; taken < steps && !exhausted; ++taken) {
        basis.col(taken) = next / next.norm();
        next = apply(basis.col(taken));
        const double image = next.norm();
        diagonal(taken) = basis.col(taken).dot(next);
        const auto known = basis.leftCols(taken + 1);
        for (int pass = 0; pass < 2; ++pass) next -= known * (known.transpose() * next).eval();
        beside(taken) = next.norm();
        exhausted = beside(taken) <= n * std::numeric_limits<double>::epsilon() * image;
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> tridiagonal;
    tridiagonal.computeFromTridiagonal(diagonal.head(taken), beside.head(taken - 1), Eigen::EigenvaluesOnly);
    return tridiagonal.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

Spectrum spectrum(const SparseMatrix& symmetric, const std::vector<bool>& prescribed)
{
    const SparseMatrix block = free_block(symmetric, prescribed);
    auto inverse = prepare(block, LinearSolver::cholmod);
    if (!inverse->usable()) inverse = prepare(block, LinearSolver::umfpack);  // indefinite
    const double largest = largest_eigenvalue([&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return block * x; }, block.rows());
    const double of_inverse = largest_eigenvalue([&](const Eigen::VectorXd& x) { return inverse->solve(x); }, block.rows());
    return {static_cast<int>(block.rows()), largest, 1.0 / of_inverse};
}

Spectrum spectrum(const BoundaryValueSolution& solution, const ElasticMaterial& material)
{
    const LinearFlesh flesh(*solution.space, lame_parameters(material.young_pa, material.poisson), solution.formulation);
    return spectrum(flesh.stiffness(), flesh.prescribed(solution.held));
}

double rounding_bound(const Spectrum& spectrum)
{
    return std::sqrt(static_cast<double>(spectrum.unknowns)) * std::numeric_limits<double>::epsilon() * spectrum.condition();
}

}  // namespace reference_fem
