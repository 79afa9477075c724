// Reference: free fall in closed form, for the particles that Algorithm 1 integrates.
#include "pbs/solver/algorithm_1.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Algorithm1;
using pbs::PbsOptions;
using pbs::Positions;
using pbs::Vec3;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({8, 2, 2}, Vec3::UnitZ(), 0.0);
const std::vector<bool> all(limb.mesh.rest.rows(), true), none(limb.mesh.rest.rows(), false);
constexpr double dt = 0.01;

PbsOptions jiggling_freely()
{
    PbsOptions options;
    options.k_stretch = options.k_volume = options.k_bind = 0.0;
    options.gravity_m_s2 = Vec3(0, 0, -9.81);
    options.jiggle = pbs::Jiggle{0.0};
    return options;
}

template <typename Scalar>
Positions advanced(const std::vector<bool>& zone, const PbsOptions& options, int steps)
{
    Algorithm1<Scalar> algorithm(limb.mesh, limb.binding.distance, zone, options);
    for (int step = 0; step < steps; ++step) algorithm.advance(limb.lbs, limb.bind_points, dt);
    return algorithm.positions();
}

TEST(Algorithm1, UnconstrainedParticlesFallFreely)
{
    // Symplectic Euler: after n steps x = x0 + a dt^2 n (n + 1) / 2.
    const Vec3 fall(0, 0, -9.81 * dt * dt * 10 * 11 / 2);
    const Positions expected = limb.lbs.rowwise() + fall.transpose();
    // A rounding of a position, of coordinates up to 1 m, changes the velocity and is repeated in each later step: n (n
    // + 1) / 2 roundings, and five of the expected position.
    using test_support::rounding_error_in;
    EXPECT_LT((advanced<double>(all, jiggling_freely(), 10) - expected).cwiseAbs().maxCoeff(),
              rounding_error_in<double>(55 + 5, 1.0));
    EXPECT_LT((advanced<float>(all, jiggling_freely(), 10) - expected).cwiseAbs().maxCoeff(),
              rounding_error_in<float>(55 + 5, 1.0));
}

TEST(Algorithm1, ParticlesOutsideTheZoneDoNotFall)
{
    std::vector<bool> half = none;
    for (std::size_t i = 0; i < half.size(); ++i) half[i] = i % 2 == 0;
    const Positions positions = advanced<double>(half, jiggling_freely(), 10);
    for (Eigen::Index i = 0; i < positions.rows(); ++i) EXPECT_EQ(positions.row(i) == limb.lbs.row(i), i % 2 == 1);
}

TEST(Algorithm1, NothingJigglesInAnEmptyZoneAndWithoutTheOptions)
{
    for (const std::vector<bool>& zone : {none, {}}) EXPECT_EQ(advanced<double>(zone, jiggling_freely(), 3), limb.lbs);
    PbsOptions options = jiggling_freely();
    options.jiggle.reset();
    EXPECT_EQ(advanced<double>(all, options, 3), limb.lbs);
}

TEST(Algorithm1, JigglingParticlesAtRestStayAtRestExactly)
{
    PbsOptions options;
    options.jiggle = pbs::Jiggle{0.1};
    EXPECT_EQ(advanced<double>(all, options, 20), limb.mesh.rest);
}

TEST(Algorithm1, JigglingParticlesLagBehindAndFollow)
{
    PbsOptions options;
    options.jiggle = pbs::Jiggle{0.1};
    Algorithm1<double> algorithm(limb.mesh, limb.binding.distance, all, options);
    algorithm.advance(limb.lbs, limb.bind_points, dt);
    const Eigen::RowVector3d shift(0, 0.02, 0);
    algorithm.advance(limb.lbs.rowwise() + shift, limb.bind_points.rowwise() + shift, dt);
    const Positions once = algorithm.positions();
    // the sides of the bind spheres do not follow
    EXPECT_GT((once.rowwise() - shift - limb.lbs).rowwise().norm().maxCoeff(), 1e-3);
    algorithm.advance(limb.lbs.rowwise() + shift, limb.bind_points.rowwise() + shift, dt);
    EXPECT_NE(algorithm.positions(), once);  // it still has a velocity
}

// In Scalar a target is rounded once, and a correction of the whole distance some ten times (projection_rounding.hpp).
TEST(Algorithm1, BindToTheBlendedPositionOfStiffnessOneGoesBackToIt)
{
    PbsOptions options;
    options.k_stretch = options.k_volume = 0.0;
    options.bind_to = pbs::BindTo::blended_position;
    options.iterations = 1;
    const Positions blend = 1.1 * limb.lbs;
    for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered}) {
        options.order = order;
        options.jiggle = pbs::Jiggle{0.0};
        options.gravity_m_s2 = Vec3(0, 0, -9.81);
        Algorithm1<double> algorithm(limb.mesh, limb.binding.distance, all, options);
        for (int step = 0; step < 3; ++step) algorithm.advance(blend, limb.bind_points, dt);
        EXPECT_LE((algorithm.positions() - blend).cwiseAbs().maxCoeff(),
                  test_support::rounding_error_in<double>(2 * 11, 1.1));
        options.bind_to = pbs::BindTo::bone_distance;
        Algorithm1<double> free(limb.mesh, limb.binding.distance, all, options);
        for (int step = 0; step < 3; ++step) free.advance(blend, limb.bind_points, dt);
        EXPECT_GT((free.positions() - blend).cwiseAbs().maxCoeff(), 1e-3) << "the distances alone leave it elsewhere";
        options.bind_to = pbs::BindTo::blended_position;
    }
}

TEST(Algorithm1, TimeStepMattersOnlyWhereParticlesAreIntegrated)
{
    Algorithm1<double> jiggling(limb.mesh, limb.binding.distance, all, jiggling_freely());
    EXPECT_THROW(jiggling.advance(limb.lbs, limb.bind_points, 0.0), pbs::InputError);
    Algorithm1<double> still(limb.mesh, limb.binding.distance, {}, {});
    EXPECT_NO_THROW(still.advance(limb.lbs, limb.bind_points, 0.0));
}

TEST(Algorithm1, RefusesATetOfNoVertexBeforeItMeasuresAnyEdge)
{
    PbsOptions options;
    options.sleep = true;
    pbs::TetMesh mesh = limb.mesh;
    mesh.tets(0, 3) = 1 << 30;
    EXPECT_THROW(Algorithm1<double>(mesh, limb.binding.distance, none, options), pbs::InputError);
}

}  // namespace
