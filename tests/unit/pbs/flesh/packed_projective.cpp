// Reference: the plain implementation of the same energy, whose local step uses eigenvectors and no formula.
#include "pbs/flesh/flesh_system.hpp"
#include "pbs/flesh/held_flesh.hpp"
#include "pbs/flesh/packed_flesh.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "tests/support/evaluated_flesh.hpp"
#include "tests/support/four_threads.hpp"
#include "tests/support/held_bar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using pbs::Positions;
using pbs::Vec3;
using test_support::Evaluated;
using test_support::evaluated;

struct Flesh {
    explicit Flesh(const std::array<int, 3>& cells, bool keeps_volume = true, const Vec3& joint = Vec3::Zero())
        : bent(test_support::two_bone_limb(cells, Vec3::UnitZ(), 70.0, joint)),
          held(bent.mesh, test_support::springs_at(joint), 2,
               {.poisson = 0.45, .volume_share = pbs::volume_share_of_projective(0.45, keeps_volume)}),
          energy(bent.mesh, pbs::projective_weights(0.45, keeps_volume), held.hold())
    {
        held.hold().centres(bent.pose, centres);
    }
    test_support::TwoBoneLimb bent;
    pbs::HeldFlesh held;
    pbs::ProjectiveEnergy energy;
    Positions centres;
};

// How much a rounding of the entries of F changes the shapes: the nearest rotation by 1 / (s_2 + s_3) and less, the nearest matrix of
// determinant one by (P_23 / (P_23 - kappa)) and less, which the formulae keep below ten. F itself has rounding of x over the edge's
// length.
constexpr double amplification = 10.0;

// Each entry of the gradient sums some 25 tets with some 60 roundings of terms as large as the weights, V0 and the gradients are.
template <typename Scalar>
double tolerance(const Flesh& flesh, const Positions& x)
{
    double part = 0.0;
    for (const pbs::ProjectiveTet& tet : flesh.energy.tets()) {
        const double of_f = (x.rowwise() - x.colwise().mean()).rowwise().norm().maxCoeff() * tet.inverse_edges.norm();
        const double size = std::max(1.0, of_f);  // of the terms of F, R and D
        part = std::max(part, tet.volume * tet.inverse_edges.norm() * size);
    }
    const double weights = flesh.energy.weights().strain + flesh.energy.weights().volume;
    return 25 * 60 * amplification * std::numeric_limits<Scalar>::epsilon() * weights * part;
}

// Returns how many tets were refused by the formulae.
template <typename Scalar>
int expect_equal_to_plain(const Flesh& flesh, const Positions& x)
{
    pbs::PlainProjective plain(flesh.energy, flesh.held.factor());
    pbs::PackedProjective<Scalar> packed(flesh.bent.mesh, flesh.energy, flesh.held.factor(), 1);
    const Evaluated expected = evaluated<double>(plain, flesh.centres, x), found = evaluated<Scalar>(packed, flesh.centres, x);
    const double bound = tolerance<Scalar>(flesh, x);
    EXPECT_LE((found.gradient - expected.gradient).cwiseAbs().maxCoeff(), bound);
    // The energy changes with x by its gradient, and its terms are rounded as those of the gradient are, times a displacement.
    EXPECT_NEAR(found.energy, expected.energy,
                bound * std::max(x.cwiseAbs().maxCoeff(), flesh.centres.cwiseAbs().maxCoeff()) * std::sqrt(double(x.size())));
    EXPECT_GT(expected.gradient.cwiseAbs().maxCoeff(), 4.0 * bound);
    int refused = 0;
    for (const auto& slab : packed.tets()) refused += slab.refused();
    return refused;
}

TEST(PackedProjective, EqualsPlainInDouble)
{
    for (const bool keeps_volume : {true, false}) {
        const Flesh flesh({10, 3, 3}, keeps_volume);
        EXPECT_EQ(expect_equal_to_plain<double>(flesh, flesh.bent.lbs), 0);
        EXPECT_EQ(expect_equal_to_plain<double>(flesh, test_support::jittered(flesh.bent.lbs, 0.01)), 0);
    }
}

TEST(PackedProjective, EqualsPlainInFloat)
{
    const Flesh flesh({10, 3, 3});
    EXPECT_EQ(expect_equal_to_plain<float>(flesh, flesh.bent.lbs), 0);
    EXPECT_EQ(expect_equal_to_plain<float>(flesh, test_support::jittered(flesh.bent.lbs, 0.01)), 0);
}

TEST(PackedProjective, EqualsPlainInFloatFarFromTheOrigin)
{
    const Flesh flesh({10, 3, 3}, true, {1000.0, -500.0, 200.0});
    Positions x = flesh.bent.lbs;
    expect_equal_to_plain<float>(flesh, test_support::jittered(x, 0.01));
}

TEST(PackedProjective, EqualsPlainAtRest)
{
    const Flesh flesh({6, 2, 2});
    EXPECT_EQ(expect_equal_to_plain<double>(flesh, flesh.bent.mesh.rest), 0);
    EXPECT_EQ(expect_equal_to_plain<float>(flesh, flesh.bent.mesh.rest), 0);
}

// Inverted and crushed tets, and tets of many times their volume: what the formulae refuse goes to the plain code.
TEST(PackedProjective, EqualsPlainOnTornTets)
{
    const Flesh flesh({10, 3, 3});
    EXPECT_GT(expect_equal_to_plain<double>(flesh, test_support::jittered(flesh.bent.lbs, 0.2)), 0);
    EXPECT_GT(expect_equal_to_plain<float>(flesh, test_support::jittered(flesh.bent.lbs, 0.2)), 0);
}

TEST(PackedProjective, EqualsPlainOnCollapsedTets)
{
    const Flesh flesh({6, 2, 2});
    Positions flat = flesh.bent.lbs;
    flat.col(2) *= 1e-3;
    expect_equal_to_plain<double>(flesh, flat);
    expect_equal_to_plain<float>(flesh, flat);
    EXPECT_EQ(expect_equal_to_plain<double>(flesh, Positions::Zero(flat.rows(), 3)), flesh.bent.mesh.tets.rows());
}

template <typename Scalar>
void expect_threads_to_change_no_bit(const Flesh& flesh)
{
    const Positions x = test_support::jittered(flesh.bent.lbs, 0.01);
    pbs::PackedProjective<Scalar> alone(flesh.bent.mesh, flesh.energy, flesh.held.factor(), 1);
    const Evaluated expected = evaluated<Scalar>(alone, flesh.centres, x);
    for (const int threads : {2, 4}) {
        pbs::PackedProjective<Scalar> shared(flesh.bent.mesh, flesh.energy, flesh.held.factor(), threads);
        const Evaluated found = evaluated<Scalar>(shared, flesh.centres, x);
        EXPECT_EQ(found.energy, expected.energy);
        EXPECT_EQ(found.gradient, expected.gradient);
        EXPECT_EQ(found.preconditioned, expected.preconditioned);
    }
}

// 13,005 vertices: enough slabs for several threads.
TEST(PackedProjective, ThreadsChangeNoBit)
{
    const Flesh flesh({44, 16, 16});
    ASSERT_GE(test_support::slabs_of(flesh.bent.mesh), 4);
    expect_threads_to_change_no_bit<float>(flesh);
    expect_threads_to_change_no_bit<double>(flesh);
}

// The limit is the minimum of the same energy; steps fall linearly, by a factor below 0.99 in this case.
TEST(PackedProjective, EveryArithmeticEndsAtOneMinimum)
{
    const Flesh flesh({6, 2, 2});
    const auto minimum = [&]<typename Scalar>(Scalar, pbs::Arithmetic arithmetic) {
        pbs::ProjectiveDynamics<Scalar> solver(flesh.bent.mesh, flesh.energy, flesh.held.factor(),
                                               {.iterations = 1000, .stop_step = 1e-11, .arithmetic = arithmetic});
        Positions x = flesh.bent.lbs;
        solver.minimise(flesh.centres, x);
        return x;
    };
    const Positions plain = minimum(0.0, pbs::Arithmetic::plain_f64);
    EXPECT_LT((minimum(0.0, pbs::Arithmetic::packed_f64) - plain).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((minimum(0.0f, pbs::Arithmetic::packed_f32) - plain).cwiseAbs().maxCoeff(), 1e-4);
    EXPECT_GT((flesh.bent.lbs - plain).cwiseAbs().maxCoeff(), 0.01);
}

TEST(PackedProjective, NotFiniteIsAnOutcome)
{
    const Flesh flesh({4, 2, 2});
    pbs::ProjectiveDynamics<float> solver(flesh.bent.mesh, flesh.energy, flesh.held.factor(), {.iterations = 10});
    Positions x = flesh.bent.lbs;
    x(3, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(solver.minimise(flesh.centres, x).iterations, 0);
    EXPECT_FALSE(x.allFinite());
}

}  // namespace
