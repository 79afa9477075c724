#include "reference_fem/dynamics/first_mode.hpp"

#include "reference_fem/eliminated_system.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <random>

namespace reference_fem {
namespace {

constexpr int block_size = 8;  // the error falls by omega_1^2 / omega_9^2 an iteration
constexpr int most_iterations = 100;
constexpr double shape_tolerance = 1e-13;

Eigen::MatrixXd random_block(const std::vector<bool>& prescribed)
{
    const auto free = std::count(prescribed.begin(), prescribed.end(), false);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    Eigen::MatrixXd block(prescribed.size(), std::min<Eigen::Index>(block_size, free));
    for (Eigen::Index i = 0; i < block.rows(); ++i)
        for (Eigen::Index k = 0; k < block.cols(); ++k) block(i, k) = prescribed[i] ? 0.0 : entry(random);
    return block;
}

Eigen::VectorXd scaled(const Eigen::VectorXd& shape)
{
    Eigen::Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    return shape / shape(largest);
}

}  // namespace

Mode first_mode(const SparseMatrix& stiffness, const ConsistentMass& mass, const std::vector<bool>& prescribed, LinearSolver solver)
{
    Eigen::MatrixXd block = random_block(prescribed), with_mass(block.rows(), block.cols());
    Mode mode{std::numeric_limits<double>::quiet_NaN(), Eigen::VectorXd::Zero(block.rows())};
    if (block.cols() == 0) return mode;
    const EliminatedSystem system(stiffness, prescribed, solver);
    if (!system.usable()) return mode;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(block.rows());
    for (int k = 0; k < most_iterations; ++k) {
        for (Eigen::Index i = 0; i < block.cols(); ++i) block.col(i) = system.solve(mass.times(block.col(i)), zero).displacement;
        for (Eigen::Index i = 0; i < block.cols(); ++i) with_mass.col(i) = mass.times(block.col(i));
        // Ritz vectors: the modes of the body that may move in the block only.
        const Eigen::MatrixXd reduced_stiffness = block.transpose() * (stiffness * block), reduced_mass = block.transpose() * with_mass;
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(reduced_stiffness, reduced_mass);
        block = (block * ritz.eigenvectors()).eval();
        const Eigen::VectorXd before = mode.shape;
        mode = {std::sqrt(ritz.eigenvalues()(0)), scaled(block.col(0))};
        if ((mode.shape - before).norm() < shape_tolerance * mode.shape.norm()) break;
    }
    return mode;
}

}  // namespace reference_fem
