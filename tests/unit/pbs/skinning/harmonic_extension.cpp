// Reference: functions that are linear in the place are harmonic, and linear elements represent them exactly. The term 1e-9 that keeps the
// system regular and the removal of weights below 1e-6 change weights by less than 3e-6.
#include "pbs/skinning/weights.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::harmonic_extension;

constexpr double extension_tolerance = 3e-6;
const pbs::TetMesh extension_bar = test_support::structured_bar({0, 0, 0}, {1, 1, 0.5}, {6, 5, 4});

Eigen::MatrixXd dense(const pbs::Weights& weights, int bones)
{
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(weights.vertices(), bones);
    for (int v = 0; v < weights.vertices(); ++v)
        for (int e = weights.first[v]; e < weights.first[v + 1]; ++e) matrix(v, weights.bone[e]) += weights.weight[e];
    return matrix;
}

// Three weights that are linear in the place and sum to one.
Eigen::MatrixXd linear_weights_of(const pbs::Positions& rest)
{
    Eigen::MatrixXd weights(rest.rows(), 3);
    weights.col(0) = 0.2 + 0.3 * rest.col(0).array();
    weights.col(1) = 0.1 + 0.2 * rest.col(1).array() + 0.1 * rest.col(2).array();
    weights.col(2) = 1.0 - weights.col(0).array() - weights.col(1).array();
    return weights;
}

TEST(HarmonicExtension, ReproducesLinearWeightsFromTheBoundary)
{
    const std::vector<bool> boundary = pbs::boundary_vertices(extension_bar.tets, extension_bar.rest.rows());
    const Eigen::MatrixXd expected = linear_weights_of(extension_bar.rest);
    Eigen::MatrixXd given = expected;
    int inside = 0;
    for (Eigen::Index v = 0; v < given.rows(); ++v)
        if (!boundary[std::size_t(v)]) {
            given.row(v).setConstant(77.0);  // not read
            ++inside;
        }
    EXPECT_EQ(inside, 5 * 4 * 3);
    EXPECT_LE((dense(harmonic_extension(extension_bar, boundary, given), 3) - expected).cwiseAbs().maxCoeff(), extension_tolerance);
}

TEST(HarmonicExtension, KeepsWeightsThatAreAllKnown)
{
    const Eigen::MatrixXd given = linear_weights_of(extension_bar.rest);
    const std::vector<bool> all(std::size_t(given.rows()), true);
    EXPECT_LE((dense(harmonic_extension(extension_bar, all, given), 3) - given).cwiseAbs().maxCoeff(), 1e-14);
}

// Weights are from the least to the greatest known one (maximum principle, whose condition the Kuhn tets of cubes fulfil).
TEST(HarmonicExtension, StaysBetweenTheKnownWeightsAndSumsToOne)
{
    std::vector<bool> known(std::size_t(extension_bar.rest.rows()), false);
    Eigen::MatrixXd given = Eigen::MatrixXd::Zero(extension_bar.rest.rows(), 2);
    for (Eigen::Index v = 0; v < given.rows(); ++v) {
        if (v % 5 != 0) continue;
        known[std::size_t(v)] = true;
        given(v, 0) = v % 2 == 0 ? 0.25 : 0.75;
        given(v, 1) = 1.0 - given(v, 0);
    }
    const Eigen::MatrixXd extended = dense(harmonic_extension(extension_bar, known, given), 2);
    EXPECT_GE(extended.minCoeff(), 0.25 - extension_tolerance);
    EXPECT_LE(extended.maxCoeff(), 0.75 + extension_tolerance);
    EXPECT_LE((extended.rowwise().sum().array() - 1.0).abs().maxCoeff(), 1e-14);
}

TEST(HarmonicExtension, RemovesWeightsOfAMillionthAndDividesByTheSumOfTheOthers)
{
    const std::vector<bool> all(std::size_t(extension_bar.rest.rows()), true);
    Eigen::MatrixXd given = Eigen::MatrixXd::Zero(extension_bar.rest.rows(), 3);
    given.col(0).setConstant(0.5);
    given.col(1).setConstant(5e-7);
    given.col(2).setConstant(1.5);
    const Eigen::MatrixXd weights = dense(harmonic_extension(extension_bar, all, given), 3);
    EXPECT_EQ(weights.col(0).minCoeff(), 0.25);
    EXPECT_EQ(weights.col(1).maxCoeff(), 0.0);
    EXPECT_EQ(weights.col(2).maxCoeff(), 0.75);
}

TEST(HarmonicExtension, WithoutAnyKnownWeightBelongsToTheFirstBone)
{
    const std::vector<bool> none(std::size_t(extension_bar.rest.rows()), false);
    const Eigen::MatrixXd given = Eigen::MatrixXd::Zero(extension_bar.rest.rows(), 2);
    EXPECT_EQ(dense(harmonic_extension(extension_bar, none, given), 2).col(0).minCoeff(), 1.0);
}

}  // namespace
