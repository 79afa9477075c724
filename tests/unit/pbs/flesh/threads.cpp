// Reference: the same solve on one thread. Threads share the slabs of a mesh, which no number of threads changes.
#include "pbs/flesh/held_flesh.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/flesh/quasi_newton.hpp"
#include "pbs/flesh/vbd.hpp"
#include "tests/support/four_threads.hpp"
#include "tests/support/held_xpbd.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Arithmetic;
using pbs::Positions;

template <typename Scalar>
class FleshOnThreads : public testing::Test {
public:
    static constexpr Arithmetic arithmetic = std::is_same_v<Scalar, float> ? Arithmetic::packed_f32 : Arithmetic::packed_f64;
};
using ScalarsOnThreads = testing::Types<float, double>;
TYPED_TEST_SUITE(FleshOnThreads, ScalarsOnThreads);

const test_support::TwoBoneLimb& large_limb()
{
    static const test_support::TwoBoneLimb limb = test_support::two_bone_limb({44, 16, 16}, pbs::Vec3::UnitZ(), 70.0);
    return limb;
}

// Three slabs of one parity at most, and three is the least number that is shared.
TEST(FleshOnThreads, TheMeshHasSeveralSlabs)
{
    EXPECT_GE(test_support::slabs_of(large_limb().mesh), 4);
}

const pbs::HeldFlesh& large_flesh()
{
    static const pbs::HeldFlesh flesh(large_limb().mesh, test_support::springs_at(pbs::Vec3::Zero()), 2, {});
    return flesh;
}

const Positions& centres_of_large_flesh()
{
    static const Positions centres = [] {
        Positions of_pose;
        large_flesh().hold().centres(large_limb().pose, of_pose);
        return of_pose;
    }();
    return centres;
}

// minimise(threads, x): x is the initial guess and the result.
template <typename Minimise>
void expect_same_bits(const Minimise& minimise)
{
    const Positions from = test_support::jittered(large_limb().lbs, 0.002);
    Positions alone = from;
    minimise(1, alone);
    EXPECT_GT((alone - from).cwiseAbs().maxCoeff(), 1e-4) << "nothing moved";
    for (const int threads : {2, 4}) {
        Positions shared = from;
        minimise(threads, shared);
        EXPECT_EQ(shared, alone) << threads << " threads";
    }
}

// Enough iterations for the line search and for pairs of L-BFGS.
TYPED_TEST(FleshOnThreads, ChangeNoBitOfQuasiNewton)
{
    expect_same_bits([](int threads, Positions& x) {
        pbs::QuasiNewton<TypeParam> solver(large_limb().mesh, large_flesh().energy(), large_flesh().factor(),
                                           {.iterations = 4, .arithmetic = TestFixture::arithmetic, .threads = threads});
        EXPECT_EQ(solver.minimise(centres_of_large_flesh(), x).iterations, 4);
    });
}

TYPED_TEST(FleshOnThreads, ChangeNoBitOfProjectiveDynamics)
{
    const double share = pbs::volume_share_of_projective(0.45, true);
    static const pbs::HeldFlesh flesh(large_limb().mesh, test_support::springs_at(pbs::Vec3::Zero()), 2,
                                      {.poisson = 0.45, .volume_share = share});
    const pbs::ProjectiveEnergy energy(large_limb().mesh, pbs::projective_weights(0.45, true), flesh.hold());
    expect_same_bits([&](int threads, Positions& x) {
        pbs::ProjectiveDynamics<TypeParam> solver(large_limb().mesh, energy, flesh.factor(),
                                                  {.iterations = 3, .arithmetic = TestFixture::arithmetic, .threads = threads});
        EXPECT_EQ(solver.minimise(centres_of_large_flesh(), x).iterations, 3);
    });
}

TYPED_TEST(FleshOnThreads, ChangeNoBitOfNeoHookeanXpbd)
{
    static const test_support::HeldXpbd held(large_limb(), 0.8);
    expect_same_bits([](int threads, Positions& x) {
        held.minimise<TypeParam>({.iterations = 4, .arithmetic = TestFixture::arithmetic, .threads = threads}, x);
    });
}

}  // namespace
