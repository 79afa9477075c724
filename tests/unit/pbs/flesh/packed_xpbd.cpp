// Reference: the plain implementation, which visits the constraints in the same order.
#include "pbs/flesh/xpbd_neo_hookean.hpp"

#include "tests/support/four_threads.hpp"
#include "tests/support/held_xpbd.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace {

using pbs::Positions;
using test_support::HeldXpbd;

template <typename Scalar>
Positions iterated(pbs::XpbdSystem<Scalar>& system, const HeldXpbd& held, const Positions& from, int times, bool with_residual)
{
    pbs::Rows<Scalar> rows = system.rows();
    system.set_targets(held.targets);
    system.load(from, rows);
    for (int k = 0; k < times; ++k) system.iterate(rows, with_residual);
    Positions x;
    system.store(rows, x);
    return x;
}

// A visit rounds each of its quantities some 100 times, and moves vertices of at most 2 m by sums of them. Each of the some 25 tets and
// springs at a vertex passes errors on, enlarged by at most the condition number of its 2 x 2 system, which is below 10 here.
template <typename Scalar>
void expect_equal_to_plain(const HeldXpbd& held)
{
    const Positions from = test_support::jittered(held.bent.lbs, 0.01);
    for (const bool with_residual : {false, true}) {
        pbs::PackedXpbd<Scalar> packed(held.bent.mesh, held.flesh, 1);
        pbs::PlainXpbd plain(held.flesh, packed.visits());
        const Positions expected = iterated<double>(plain, held, from, 2, with_residual);
        const Positions found = iterated<Scalar>(packed, held, from, 2, with_residual);
        const double tolerance = 100 * 25 * 2 * std::numeric_limits<Scalar>::epsilon() / 2.0 * 2.0;
        EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance) << with_residual;
        EXPECT_GT((expected - from).cwiseAbs().maxCoeff(), 10.0 * tolerance);
    }
}

TEST(PackedXpbd, EqualsPlainInDouble)
{
    expect_equal_to_plain<double>(HeldXpbd({10, 3, 3}));
}

TEST(PackedXpbd, EqualsPlainInFloat)
{
    expect_equal_to_plain<float>(HeldXpbd({10, 3, 3}));
}

TEST(PackedXpbd, EqualsPlainInFloatFarFromTheOrigin)
{
    expect_equal_to_plain<float>(HeldXpbd({10, 3, 3}, 0.8, {1000.0, -500.0, 200.0}));
}

TEST(PackedXpbd, EqualsPlainOnOneTet)
{
    test_support::TwoBoneLimb limb = test_support::two_bone_limb({10, 3, 3}, pbs::Vec3::UnitZ(), 70.0);
    limb.mesh.tets = pbs::Tets(limb.mesh.tets.topRows(1));
    pbs::BoneSprings spring{Positions(1, 3), Eigen::VectorXd::Constant(1, 1.0), {0}};
    spring.points.row(0).setZero();
    for (const int v : limb.mesh.tets.row(0)) spring.points.row(0) += limb.mesh.rest.row(v) / 4.0;
    expect_equal_to_plain<double>(HeldXpbd(limb, 0.8, spring));
}

TEST(PackedXpbd, ACollapsedBodyStaysFinite)
{
    const HeldXpbd held({10, 3, 3});
    pbs::PackedXpbd<float> packed(held.bent.mesh, held.flesh, 1);
    const Positions x = iterated<float>(packed, held, Positions::Zero(held.bent.lbs.rows(), 3), 8, true);
    EXPECT_TRUE(x.allFinite());
}

TEST(PackedXpbd, VisitsEveryConstraintOnce)
{
    const HeldXpbd held({44, 8, 8});
    std::set<std::pair<bool, int>> expected, found;
    for (const pbs::XpbdVisit& visit : pbs::PlainXpbd(held.flesh).visits()) expected.insert({visit.is_hold, visit.tet});
    const std::vector<pbs::XpbdVisit> visits = pbs::PackedXpbd<float>(held.bent.mesh, held.flesh, 1).visits();
    for (const pbs::XpbdVisit& visit : visits) found.insert({visit.is_hold, visit.tet});
    EXPECT_EQ(found, expected);
    EXPECT_EQ(visits.size(), expected.size());
}

template <typename Scalar>
void expect_threads_to_iterate_alike(const HeldXpbd& held)
{
    const Positions from = test_support::jittered(held.bent.lbs, 0.002);
    pbs::PackedXpbd<Scalar> alone(held.bent.mesh, held.flesh, 1);
    const Positions expected = iterated<Scalar>(alone, held, from, 3, true);
    for (const int threads : {2, 4}) {
        pbs::PackedXpbd<Scalar> shared(held.bent.mesh, held.flesh, threads);
        EXPECT_EQ(iterated<Scalar>(shared, held, from, 3, true), expected) << threads;
    }
}

// 13,005 vertices: enough slabs for several threads.
TEST(PackedXpbd, ThreadsChangeNoBit)
{
    const HeldXpbd held({44, 16, 16});
    ASSERT_GE(test_support::slabs_of(held.bent.mesh), 4);
    expect_threads_to_iterate_alike<float>(held);
    expect_threads_to_iterate_alike<double>(held);
}

}  // namespace
