// Reference: the springs one by one, each with its point carried by the tet that contains it.
#include "pbs/flesh/bone_springs.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace bone_springs_tests {
namespace {

using pbs::Positions;
using pbs::Vec3;

// Moved as a whole: at the origin the translation of every bone would be zero.
const test_support::TwoBoneLimb bent = [] {
    test_support::TwoBoneLimb limb = test_support::two_bone_limb({12, 3, 3}, Vec3::UnitZ(), 70.0);
    for (Eigen::Isometry3d& bone : limb.pose) bone.pretranslate(Vec3(0.1, -0.2, 0.05));
    return limb;
}();

double one_by_one(const pbs::BoneSprings& springs, const Positions& x)
{
    const pbs::PointLocation where(bent.mesh);
    double energy = 0.0;
    for (Eigen::Index s = 0; s < springs.points.rows(); ++s) {
        const Vec3 point = springs.points.row(s);
        const pbs::Location at = where.locate(point);
        if (at.tet < 0) continue;
        Vec3 carried = (1.0 - at.barycentric.sum()) * x.row(bent.mesh.tets(at.tet, 0)).transpose();
        for (int c = 0; c < 3; ++c) carried += at.barycentric(c) * x.row(bent.mesh.tets(at.tet, c + 1)).transpose();
        energy += springs.stiffness(s) / 2.0 * (carried - bent.pose[springs.bone[s]] * point).squaredNorm();
    }
    return energy;
}

double summed(const pbs::BoneHold& hold, const Positions& x)
{
    Positions centres;
    hold.centres(bent.pose, centres);
    double energy = hold.constant(bent.pose, centres);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
        energy += hold.stiffness()(i) / 2.0 * (x.row(i) - centres.row(i)).squaredNorm();
    for (Eigen::Index t = 0; t < bent.mesh.tets.rows(); ++t)
        for (int e = 0; e < 6; ++e)
            energy +=
                hold.edge_stiffness()(t, e) / 2.0 *
                (x.row(bent.mesh.tets(t, pbs::edges_of_tet[e][0])) - x.row(bent.mesh.tets(t, pbs::edges_of_tet[e][1])))
                    .squaredNorm();
    return energy;
}

// Each of the 200 springs goes through some 20 sums of terms of at most k |x|^2, |x| < 2 m, k < 15.
TEST(BoneHold, HasTheEnergyOfItsSprings)
{
    const pbs::BoneSprings springs = test_support::random_springs(200, 10.0);
    const pbs::BoneHold hold(bent.mesh, springs, 2);
    EXPECT_EQ(hold.left_out(), 0);
    for (const double size : {0.0, 0.1, 1.0}) {
        const Positions x = test_support::jittered(bent.lbs, size);
        EXPECT_NEAR(summed(hold, x), one_by_one(springs, x), test_support::rounding_error(20.0 * 200, 15.0 * 16.0));
    }
}

TEST(BoneHold, LeavesSpringsOutsideTheTetsOut)
{
    pbs::BoneSprings springs = test_support::random_springs(10, 1.0);
    springs.points.row(3) << 0.5, 0.5, 0.5;
    const pbs::BoneHold hold(bent.mesh, springs, 2);
    EXPECT_EQ(hold.left_out(), 1);
    EXPECT_NEAR(hold.stiffness().sum(), springs.stiffness.sum() - springs.stiffness(3),
                test_support::rounding_error(50, 10.0));
}

TEST(BoneHold, PartsOfTheBonesAddUpToTheStiffnessAndAVertexWithoutSpringsHasNoCentre)
{
    const pbs::BoneHold many(bent.mesh, test_support::random_springs(100, 1.0), 2);
    EXPECT_LE((many.stiffness_of_bones().rowwise().sum() - many.stiffness()).cwiseAbs().maxCoeff(),
              test_support::rounding_error(100, many.stiffness().maxCoeff()));
    const pbs::BoneHold hold(bent.mesh, test_support::random_springs(1, 1.0), 2);
    Positions centres;
    hold.centres(bent.pose, centres);
    for (Eigen::Index i = 0; i < centres.rows(); ++i)
        if (hold.stiffness()(i) == 0.0) {
            EXPECT_EQ(centres.row(i), Eigen::RowVector3d::Zero());
        }
    EXPECT_EQ((hold.stiffness().array() > 0.0).count(), 4);
}

// The modes. Reference: the same springs summed over vertices and edges (BoneHold), and the definition of an
// eigenvector.

constexpr int springs = 200;
constexpr double stiffness = 10.0;  // times 0.5 to 1.5
const pbs::BoneHold& held()
{
    static const pbs::BoneHold hold(bent.mesh, test_support::random_springs(springs, stiffness), 2);
    return hold;
}

Positions gradient_of_modes(const pbs::HoldModes& modes, const Positions& x)
{
    Positions targets, gradient = Positions::Zero(x.rows(), 3);
    modes.targets(bent.pose, targets);
    for (std::size_t r = 0; r < modes.modes().size(); ++r) {
        const auto& [tet, v, k] = modes.modes()[r];
        Eigen::RowVector3d C = -targets.row(static_cast<Eigen::Index>(r));
        for (int i = 0; i < 4; ++i) C += v(i) * x.row(bent.mesh.tets(tet, i));
        for (int i = 0; i < 4; ++i) gradient.row(bent.mesh.tets(tet, i)) += k * v(i) * C;
    }
    return gradient;
}

Positions gradient_of_hold(const pbs::BoneHold& hold, const Positions& x)
{
    Positions centres, gradient(x.rows(), 3);
    hold.centres(bent.pose, centres);
    for (Eigen::Index i = 0; i < x.rows(); ++i) gradient.row(i) = hold.stiffness()(i) * (x.row(i) - centres.row(i));
    for (Eigen::Index t = 0; t < bent.mesh.tets.rows(); ++t)
        for (int e = 0; e < 6; ++e) {
            const int i = bent.mesh.tets(t, pbs::edges_of_tet[e][0]), j = bent.mesh.tets(t, pbs::edges_of_tet[e][1]);
            const Eigen::RowVector3d force = hold.edge_stiffness()(t, e) * (x.row(i) - x.row(j));
            gradient.row(i) += force;
            gradient.row(j) -= force;
        }
    return gradient;
}

// The forces of all springs on a vertex are sums of at most `springs` terms of k |x|, |x| < 3 m; the eigenvectors of 4
// x 4 matrices are orthonormal to some 50 roundings.
TEST(HoldModes, HaveTheForcesOfTheSprings)
{
    const pbs::HoldModes modes(held());
    for (const double size : {0.0, 0.1, 1.0}) {
        const Positions x = test_support::jittered(bent.lbs, size);
        const Positions expected = gradient_of_hold(held(), x);
        const double largest = held().stiffness().maxCoeff() * 3.0;
        EXPECT_LE((gradient_of_modes(modes, x) - expected).cwiseAbs().maxCoeff(),
                  test_support::rounding_error(springs + 50, largest));
        EXPECT_TRUE(size == 0.0 || expected.cwiseAbs().maxCoeff() > 1e-3 * largest);
    }
}

// beta_s^T X = X_s for every spring, so that v^T X = d at rest. A small eigenvalue magnifies the rounding of the
// moments by its reciprocal.
TEST(HoldModes, AreMetAtRest)
{
    const pbs::HoldModes modes(held());
    Positions targets;
    modes.targets(pbs::Pose(2, Eigen::Isometry3d::Identity()), targets);
    for (std::size_t r = 0; r < modes.modes().size(); ++r) {
        const auto& [tet, v, k] = modes.modes()[r];
        Eigen::RowVector3d at_rest = Eigen::RowVector3d::Zero();
        for (int i = 0; i < 4; ++i) at_rest += v(i) * bent.mesh.rest.row(bent.mesh.tets(tet, i));
        EXPECT_LE((at_rest - targets.row(static_cast<Eigen::Index>(r))).norm() * k,
                  test_support::rounding_error(springs, springs * stiffness));
    }
}

TEST(HoldModes, AreAtMostFourPerTetAndStiff)
{
    const pbs::HoldModes modes(pbs::BoneHold(bent.mesh, test_support::random_springs(2000, stiffness), 2));
    std::vector<int> of_tet(bent.mesh.tets.rows(), 0);
    for (const pbs::HoldMode& mode : modes.modes()) {
        ++of_tet[mode.tet];
        EXPECT_GT(mode.stiffness, 0.0);
        EXPECT_NEAR(mode.v.norm(), 1.0, test_support::rounding_error(50, 1.0));
    }
    EXPECT_EQ(*std::max_element(of_tet.begin(), of_tet.end()), 4);
}

// sum_s k beta beta^T has rank one: its eigenvector is beta, its eigenvalue k |beta|^2.
TEST(HoldModes, OneSpringIsOneMode)
{
    const pbs::BoneSprings spring = test_support::random_springs(1, stiffness);
    const pbs::HoldModes modes(pbs::BoneHold(bent.mesh, spring, 2));
    ASSERT_EQ(modes.modes().size(), 1u);
    const pbs::Location where = pbs::PointLocation(bent.mesh).locate(spring.points.row(0));
    Eigen::Vector4d beta;
    beta << 1.0 - where.barycentric.sum(), where.barycentric;
    const pbs::HoldMode& mode = modes.modes().front();
    EXPECT_EQ(mode.tet, where.tet);
    EXPECT_NEAR(mode.stiffness, spring.stiffness(0) * beta.squaredNorm(),
                test_support::rounding_error(50, spring.stiffness(0)));
    EXPECT_NEAR(std::abs(mode.v.dot(beta)), beta.norm(), test_support::rounding_error(50, 1.0));
}

TEST(HoldModes, NoSpringsAreNoModes)
{
    const pbs::HoldModes modes(pbs::BoneHold(bent.mesh, {Positions(0, 3), Eigen::VectorXd(0), {}}, 2));
    Positions targets;
    modes.targets(bent.pose, targets);
    EXPECT_TRUE(modes.modes().empty());
    EXPECT_EQ(targets.rows(), 0);
}

}  // namespace
}  // namespace bone_springs_tests
