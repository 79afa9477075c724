// Invariances of the metrics: rigid motion, order of tets and vertices, unit of length. Reference: none of them changes
// a ratio of volumes or lengths. Tolerance: the rounding of the moved positions, of volumes and of lengths.
#include "analysis/metrics/frame_metrics.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>

#include <random>

namespace {

using analysis::FrameMetrics;
using analysis::MeshMetrics;
using pbs::Positions;

struct Sample {
    pbs::TetMesh mesh;
    Positions frame;
};

Sample wobbled_bar()
{
    Sample sample{test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {20, 3, 3}), {}};
    sample.frame = sample.mesh.rest;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> offset(-0.05, 0.05);
    for (double& coordinate : sample.frame.reshaped()) coordinate += offset(random);
    return sample;
}

FrameMetrics measure(const Sample& sample)
{
    return MeshMetrics(sample.mesh.rest, sample.mesh.tets).measure(sample.frame);
}

// Positions are in error by e, at most the rounding of a motion within 2.2 m; a new unit of length rounds them, and
// those at rest, once. All tets have the volume 0.1^3 / 6 at rest. An edge, of at most 0.1 sqrt 3 and another 0.1 sqrt
// 3 by the wobble, changes by 2 e, and a volume, a sixth of a product of three edges, by at most e times the square of
// the longest. It goes through ten roundings of products whose magnitudes add up to a fifth of the cube, and a length
// through five; both sides contain two of them.
void expect_same(const FrameMetrics& a, const FrameMetrics& b)
{
    using test_support::rounding_error;
    const double rest_edge = 0.1, longest = 2.0 * rest_edge * std::sqrt(3.0),
                 rest_volume = std::pow(rest_edge, 3) / 6.0;
    const double of_position = test_support::motion_error(1, 2.2);
    const double of_j =
        (of_position * longest * longest + 4.0 * rounding_error(10, std::pow(longest, 3) / 5.0)) / rest_volume;
    EXPECT_NEAR(a.volume_change_pct, b.volume_change_pct, 100.0 * of_j);
    EXPECT_NEAR(a.volume_abs_change_pct, b.volume_abs_change_pct, 100.0 * of_j);
    EXPECT_EQ(a.inverted_tets, b.inverted_tets);
    EXPECT_NEAR(a.mean_abs_j_minus_1, b.mean_abs_j_minus_1, of_j);
    EXPECT_NEAR(a.j_min, b.j_min, of_j);
    EXPECT_NEAR(a.stretch_rms, b.stretch_rms, (2.0 * of_position + 4.0 * rounding_error(5, longest)) / rest_edge);
}

TEST(FrameMetricsInvariance, SampleIsNotTrivial)
{
    const FrameMetrics metrics = measure(wobbled_bar());
    EXPECT_GT(metrics.volume_abs_change_pct, 1.0);
    EXPECT_GT(metrics.inverted_tets, 0);
    EXPECT_LT(metrics.j_min, 0.0);
}

TEST(FrameMetricsInvariance, RigidMotion)
{
    Sample moved = wobbled_bar();
    const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized());
    moved.frame = (moved.frame * turn.toRotationMatrix().transpose()).rowwise() + Eigen::RowVector3d(0.3, -0.2, 0.9);
    expect_same(measure(moved), measure(wobbled_bar()));
}

TEST(FrameMetricsInvariance, OrderOfTetsAndVertices)
{
    const Sample sample = wobbled_bar();
    const test_support::Renumbered other = test_support::renumbered(sample.mesh, 11);
    Sample shuffled{other.mesh, sample.frame};
    shuffled.frame(other.vertex, Eigen::all) = sample.frame;
    expect_same(measure(shuffled), measure(sample));
}

TEST(FrameMetricsInvariance, UnitOfLength)
{
    for (const double unit : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        SCOPED_TRACE(unit);
        Sample scaled = wobbled_bar();
        scaled.mesh.rest *= unit;
        scaled.frame *= unit;
        expect_same(measure(scaled), measure(wobbled_bar()));
    }
}

}  // namespace
