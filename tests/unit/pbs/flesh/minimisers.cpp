// The contract of the methods that minimise an energy of elastic flesh: vertex block descent, L-BFGS with either first
// matrix, XPBD with neo-Hookean constraints and projective dynamics. References: the necessary conditions of a minimum,
// computed by the plain energy, rigid motions, and the same bar without a sliver, whose volume is 1e-9 of that of a
// tet, so that the minimum does not depend on it.
#include "pbs/flesh/flesh_system.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/flesh/quasi_newton.hpp"
#include "pbs/flesh/vbd.hpp"
#include "pbs/flesh/warped_newton.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/blend.hpp"
#include "tests/support/flesh_rounding.hpp"
#include "tests/support/held_xpbd.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace minimisers_tests {
namespace {

using pbs::Positions;
using test_support::HeldXpbd;
using test_support::rounding_error;

const HeldXpbd bent_bar({8, 2, 2}), bar_of_slivers({12, 3, 3});
const Positions &lbs = bent_bar.bent.lbs, &rest = bent_bar.bent.mesh.rest;
const pbs::Pose rest_pose(2, Eigen::Isometry3d::Identity());

// How a method is called. setting: one of the method's `settings`, or the first of them; stop: its threshold of
// convergence, if it has one.
struct Call {
    int iterations;
    bool packed = true;
    std::optional<double> setting = {};
    double stop = 0.0;
};

Positions centres_of(const HeldXpbd& bar, const pbs::Pose& pose)
{
    Positions centres;
    bar.hold.centres(pose, centres);
    return centres;
}

// The energy of vertex block descent, L-BFGS and XPBD.
struct OfFlesh {
    static double value_and_gradient(const Positions& x, double, Positions& gradient)
    {
        return bent_bar.energy.value_and_gradient(x, bent_bar.centres, gradient);
    }
    static constexpr bool has_own_energy = false, descends = true;
};

// Each minimises x towards the bones of a pose, and knows how many iterations from LBS leave less than a millionth of
// the gradient. The first setting is its default.
struct ByVertices : OfFlesh {  // setting: omega
    static constexpr int enough = 600, usual = 64;
    static inline const std::vector<double> settings = {pbs::VertexBlockOptions().omega, 0.1, 1.0, 1.5, 1.99};

    template <typename Scalar>
    static auto minimise(const HeldXpbd& bar, const pbs::Pose& pose, const Call& call, Positions& x)
    {
        const pbs::VertexBlockOptions options{
            .iterations = call.iterations, .omega = *call.setting, .packed = call.packed};
        return pbs::VertexBlockDescent<Scalar>(bar.bent.mesh, bar.energy, options).minimise(centres_of(bar, pose), x);
    }
};

struct ByLbfgs : OfFlesh {  // setting: the pairs that are kept
    static constexpr int enough = 300, usual = 24, iterations_at_rest = 0;
    static inline const std::vector<double> settings = {5, 0, 1};

    template <typename Scalar>
    static auto minimise(const HeldXpbd& bar, const pbs::Pose& pose, const Call& call, Positions& x)
    {
        const pbs::HeldFlesh flesh(bar.bent.mesh, bar.springs, 2, {});
        const pbs::QuasiNewtonOptions options{.iterations = call.iterations,
                                              .history = int(*call.setting),
                                              .stop_gradient = call.stop,
                                              .packed = call.packed};
        return pbs::QuasiNewton<Scalar>(bar.bent.mesh, bar.energy, flesh.factor(), options)
            .minimise(centres_of(bar, pose), x);
    }
};

struct ByWarpedStiffness : OfFlesh {  // setting: omega
    static constexpr int enough = 100, usual = 3;
    static inline const std::vector<double> settings = {pbs::WarpedNewtonOptions().omega, 1.0, 1.9};

    template <typename Scalar>
    static auto minimise(const HeldXpbd& bar, const pbs::Pose& pose, const Call& call, Positions& x)
    {
        const pbs::HeldFlesh flesh(bar.bent.mesh, bar.springs, 2, {});
        std::vector<Eigen::Matrix3d> rotations;
        pbs::BlendSkinning<double>(bar.bent.mesh.rest, flesh.smooth_weights(bar.bent.weights))
            .rotations(pose, rotations);
        const pbs::WarpedNewtonOptions options{
            .iterations = call.iterations, .omega = *call.setting, .packed = call.packed};
        return pbs::WarpedNewton<Scalar>(bar.bent.mesh, bar.energy, flesh.factor(), options)
            .minimise(centres_of(bar, pose), rotations, x);
    }
};

struct ByXpbd : OfFlesh {
    static constexpr bool descends = false;  // its steps are those of a damped motion
    static constexpr int enough = 500, usual = 64;
    static inline const std::vector<double> settings = {0.0};

    template <typename Scalar>
    static auto minimise(const HeldXpbd& bar, const pbs::Pose& pose, const Call& call, Positions& x)
    {
        Positions targets;
        bar.flesh.hold.targets(pose, targets);
        const pbs::XpbdNeoHookeanOptions options{.iterations = call.iterations, .packed = call.packed};
        return pbs::XpbdNeoHookean<Scalar>(bar.bent.mesh, bar.flesh, options).minimise(targets, x);
    }
};

// It has an energy of its own. setting: Poisson's ratio.
struct ByProjections : OfFlesh {
    static constexpr bool has_own_energy = true;
    static constexpr int enough = 1200, usual = 60, iterations_at_rest = 1;
    static inline const std::vector<double> settings = {0.45, 0.0, 0.3};

    static pbs::ProjectiveEnergy energy(const HeldXpbd& bar, double poisson)
    {
        return {bar.bent.mesh, pbs::projective_weights(poisson, true), bar.hold};
    }
    static double value_and_gradient(const Positions& x, double poisson, Positions& gradient)
    {
        return energy(bent_bar, poisson).value_and_gradient(x, bent_bar.centres, gradient);
    }
    template <typename Scalar>
    static auto minimise(const HeldXpbd& bar, const pbs::Pose& pose, const Call& call, Positions& x)
    {
        const double poisson = *call.setting;
        const pbs::HeldFlesh flesh(
            bar.bent.mesh, bar.springs, 2,
            {.poisson = poisson, .volume_share = pbs::volume_share_of_projective(poisson, true)});
        const pbs::ProjectiveOptions options{
            .iterations = call.iterations, .stop_step = call.stop, .packed = call.packed};
        return pbs::ProjectiveDynamics<Scalar>(bar.bent.mesh, energy(bar, poisson), flesh.factor(), options)
            .minimise(centres_of(bar, pose), x);
    }
};

template <typename Method>
class Minimiser : public testing::Test {
protected:
    static constexpr int enough = Method::enough;
    static inline const double usual_setting = Method::settings.front();

    template <typename Scalar>
    static auto minimise(Call call, Positions& x, const pbs::Pose& pose = bent_bar.bent.pose,
                         const HeldXpbd& bar = bent_bar)
    {
        if (!call.setting) call.setting = usual_setting;
        return Method::template minimise<Scalar>(bar, pose, call, x);
    }
    template <typename Scalar>
    static Positions minimised(int iterations, bool packed = true, Positions x = lbs,
                               const pbs::Pose& pose = bent_bar.bent.pose)
    {
        minimise<Scalar>({iterations, packed}, x, pose);
        return x;
    }
    static double value(const Positions& x, double setting = usual_setting)
    {
        Positions gradient;
        return Method::value_and_gradient(x, setting, gradient);
    }
    static double gradient_norm(const Positions& x)
    {
        Positions gradient;
        Method::value_and_gradient(x, usual_setting, gradient);
        return gradient.norm();
    }
};
using Methods = testing::Types<ByVertices, ByLbfgs, ByWarpedStiffness, ByXpbd, ByProjections>;
TYPED_TEST_SUITE(Minimiser, Methods);

TYPED_TEST(Minimiser, EndsWhereTheGradientVanishes)
{
    for (const bool packed : {false, true}) {
        Positions x = lbs;
        const auto summary = this->template minimise<double>({this->enough, packed}, x);
        EXPECT_LT(this->gradient_norm(x), 1e-6 * this->gradient_norm(lbs));
        if constexpr (requires { summary.is_finite; }) {
            EXPECT_TRUE(summary.is_finite);
        }
    }
}

TYPED_TEST(Minimiser, TheMinimumDoesNotDependOnTheInitialGuess)
{
    const Positions expected = this->template minimised<double>(2 * this->enough);
    const double size = (lbs - rest).norm();
    for (const Positions& from : {test_support::jittered(lbs, 0.05), rest}) {
        // over-relaxed, it ends elsewhere: see vbd.cpp
        if (std::is_same_v<TypeParam, ByVertices> && from == rest) continue;
        EXPECT_LT((this->template minimised<double>(2 * this->enough, true, from) - expected).norm(), 1e-6 * size);
    }
}

// Some sum up their multipliers over the iterations, each with a rounding of its own. The stiffnesses of projective
// dynamics are not those of the energy of flesh.
TYPED_TEST(Minimiser, EveryArithmeticEndsAtOneMinimum)
{
    const int iterations = std::is_same_v<TypeParam, ByXpbd> ? 100 : this->enough;
    const Positions expected = this->template minimised<double>(2 * this->enough, false);
    const Positions difference = this->template minimised<float>(iterations) - expected;
    if (TypeParam::has_own_energy) {
        EXPECT_LT((this->template minimised<double>(2 * this->enough) - expected).cwiseAbs().maxCoeff(), 1e-9);
        EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-4);
    } else {
        EXPECT_LT(difference.norm(),
                  test_support::displaced_by_rounding<float>(bent_bar.energy, bent_bar.centres, expected,
                                                             std::is_same_v<TypeParam, ByXpbd> ? iterations : 0));
    }
    EXPECT_GT((lbs - expected).cwiseAbs().maxCoeff(), 0.01);
}

TYPED_TEST(Minimiser, NoIterationsLeaveTheInitialGuess)
{
    EXPECT_EQ(this->template minimised<double>(0, false), lbs);
}

// Theory. Vertex block descent: along a vertex the energy is exactly quadratic, so that omega times the way to its
// minimum lowers it by omega (2 - omega) / 2 g . H^-1 g, which is positive for 0 < omega < 2. L-BFGS: the line search
// requires it, or a step is taken back. Projective dynamics: each step minimises the energy over the shapes and then
// over the positions. An energy has some 40 roundings per tet of positive terms; in that of projective dynamics, a
// hundred of the springs' parts, which have either sign: a_i |x_i - c_i|^2 of a body of 2 m.
TYPED_TEST(Minimiser, NoIterationIncreasesTheEnergy)
{
    if (!TypeParam::descends) return;
    const double of_tets = rounding_error(40.0 * double(bent_bar.bent.mesh.tets.rows()), 1.0),
                 of_springs = rounding_error(100.0, 4.0 * bent_bar.hold.stiffness().sum());
    for (const Positions& from : {lbs, rest, test_support::mirrored(lbs, 1), test_support::mirrored(lbs),
                                  test_support::jittered(lbs, 0.2), Positions(0.0 * lbs)})
        for (const double setting : TypeParam::settings) {
            const double before = this->value(from, setting);
            double last = before;
            for (const int iterations : {1, 2, 3, 5, 8, 12, 21, 40}) {
                Positions x = from;
                this->template minimise<double>({iterations, false, setting}, x);
                const double now = this->value(x, setting);
                EXPECT_LE(now, last + (TypeParam::has_own_energy ? of_springs : of_tets * last))
                    << setting << ", " << iterations;
                last = now;
            }
            EXPECT_LT(last, before);
        }
}

// A step of rounding is no step.
TYPED_TEST(Minimiser, RestsWhereItsBonesRest)
{
    for (const bool packed : {false, true}) {
        Positions x = rest;
        const auto summary =
            this->template minimise<double>({.iterations = 5, .packed = packed, .stop = 1e-3}, x, rest_pose);
        EXPECT_LT((this->template minimised<double>(5, packed, rest, rest_pose) - rest).cwiseAbs().maxCoeff(), 1e-12);
        if constexpr (requires { summary.converged; }) {
            EXPECT_TRUE(summary.converged);
            EXPECT_EQ(summary.iterations, TypeParam::iterations_at_rest);
            EXPECT_LT(summary.steps.front(), 1e-12);
            EXPECT_TRUE(this->template minimise<float>({.iterations = 5, .stop = 1e-3}, x = rest, rest_pose).converged);
        }
    }
}

// Also by 1e5 sizes of the body: positions go through some hundred roundings of that distance in each iteration.
// Warped Newton alone is at its minimum within these iterations. There it keeps a step or takes it back by the energy
// E, whose rounding of 16 epsilon |E| is the energy lambda d^2 / 2 of a displacement d along the softest mode, of
// stiffness lambda.
TYPED_TEST(Minimiser, TurnsWithARigidMotionOfAllBones)
{
    test_support::RandomPoints random(73);
    for (const double distance : {0.5, 2e5}) {
        const Eigen::Isometry3d motion = random.rigid_motion(distance);
        pbs::Pose pose = bent_bar.bent.pose;
        for (Eigen::Isometry3d& bone : pose) bone = motion * bone;
        const Positions here = this->template minimised<double>(20, false),
                        there =
                            this->template minimised<double>(20, false, test_support::transformed(lbs, motion), pose);
        double bound = 1e-10 + (distance > 1.0 ? rounding_error(20 * 100, distance) : 0.0);
        if constexpr (std::is_same_v<TypeParam, ByWarpedStiffness>) {
            const double energy_rounding = 16.0 * std::numeric_limits<double>::epsilon() * std::abs(this->value(here));
            const auto stiffness =
                test_support::stiffnesses(bent_bar.energy, centres_of(bent_bar, bent_bar.bent.pose), here);
            bound += std::sqrt(2.0 * energy_rounding / stiffness.minCoeff());
        }
        EXPECT_LT((there - test_support::transformed(here, motion)).rowwise().norm().maxCoeff(), bound);
    }
}

// Inverted tets and tets without volume are finite energies, from which the forces point back. There is more than one
// minimum.
TYPED_TEST(Minimiser, InvertedAndCollapsedInitialGuessesGoDown)
{
    for (const Positions& from :
         {test_support::mirrored(lbs), test_support::jittered(lbs, 0.15), Positions(0.0 * lbs)}) {
        const Positions x = this->template minimised<double>(2 * this->enough, true, from);
        EXPECT_TRUE(x.allFinite());
        EXPECT_LT(this->value(x), this->value(from));
        EXPECT_LT(this->gradient_norm(x), 1e-6 * this->gradient_norm(from));
    }
}

template <typename Summary>
void expect_reported(const Summary& summary, const Positions& x)
{
    EXPECT_FALSE(x.allFinite());
    if constexpr (requires { summary.is_finite; }) {
        EXPECT_FALSE(summary.is_finite);
    }
    if constexpr (requires { summary.converged; }) {
        EXPECT_EQ(summary.iterations, 0);
    }
}

TYPED_TEST(Minimiser, AnInitialGuessThatIsNotANumberIsNotHidden)
{
    Positions from = lbs;
    from(3, 1) = std::numeric_limits<double>::quiet_NaN();
    for (const bool packed : {false, true}) {
        Positions x = from;
        expect_reported(this->template minimise<double>({5, packed}, x), x);
    }
    Positions x = from;
    expect_reported(this->template minimise<float>({5}, x), x);
}

constexpr double regular_flatness = 0.1178511301977579;  // 1 / (6 sqrt 2)

// The bar with a further vertex above a face of its boundary next to the joint: a tet of this volume over its longest
// edge cubed.
HeldXpbd with_sliver(double flatness)
{
    const pbs::TetMesh& whole = bar_of_slivers.bent.mesh;
    const pbs::Triangles boundary = pbs::boundary_of(whole.tets);
    Eigen::Index nearest = 0;
    double least = 1e9;
    for (Eigen::Index f = 0; f < boundary.rows(); ++f) {
        const double distance = std::abs(whole.rest(boundary.row(f), 0).sum() / 3.0 - 0.05);
        if (distance < least) least = distance, nearest = f;
    }
    const pbs::Vec3 a = whole.rest.row(boundary(nearest, 0)), b = whole.rest.row(boundary(nearest, 1)),
                    c = whole.rest.row(boundary(nearest, 2));
    const pbs::Vec3 outward = (b - a).cross(c - a);  // twice the area long
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double height = 6.0 * flatness * std::pow(longest, 3) / outward.norm();
    pbs::TetMesh mesh{Positions(whole.rest.rows() + 1, 3), pbs::Tets(whole.tets.rows() + 1, 4)};
    mesh.rest << whole.rest, ((a + b + c) / 3.0 + height * outward.normalized()).transpose();
    mesh.tets << whole.tets, boundary.row(nearest), static_cast<int>(whole.rest.rows());
    test_support::TwoBoneLimb limb = test_support::two_bones_in(mesh);
    test_support::pose_limb(limb, bar_of_slivers.bent.pose);
    return HeldXpbd(test_support::HeldBar(limb, bar_of_slivers.springs));
}

TEST(Slivers, AreAsStiffAsRegularTetsAndOthersKeepTheirStiffness)
{
    EXPECT_EQ(bar_of_slivers.energy.slivers(), 0);
    for (const double flatness : {2e-5, 0.9e-5, 7e-10}) {
        const HeldXpbd bar = with_sliver(flatness);
        const Eigen::Index last = bar.bent.mesh.tets.rows() - 1;
        const double expected = flatness < 1e-5 ? flatness / regular_flatness : 1.0;
        // the height has five digits next to the places
        EXPECT_NEAR(pbs::sliver_factor(bar.bent.mesh, last), expected, 1e-5 * expected);
        EXPECT_EQ(pbs::sliver_factor(bar.bent.mesh, 0), 1.0);
        EXPECT_EQ(bar.energy.slivers(), flatness < 1e-5);
        for (std::size_t t = 0; t + 1 < bar.energy.tets().size(); ++t) {
            EXPECT_EQ(bar.energy.tets()[t].w, bar_of_slivers.energy.tets()[t].w) << t;
            EXPECT_EQ(bar.energy.tets()[t].kappa, bar_of_slivers.energy.tets()[t].kappa) << t;
        }
    }
}

// In float the sliver is turned within the usual iterations. The difference is that at the vertices which the two bars
// share, over the displacement from rest.
TYPED_TEST(Minimiser, ASliverDoesNotMoveTheMinimum)
{
    if (std::is_same_v<TypeParam, ByXpbd>) return;  // its tets have their own stiffness, however flat they are
    const auto difference = [&]<typename Scalar>(Scalar, int iterations, double flatness) {
        const HeldXpbd bar = with_sliver(flatness);
        Positions with = bar.bent.lbs, without = bar_of_slivers.bent.lbs;
        this->template minimise<Scalar>({iterations}, with, bar.bent.pose, bar);
        this->template minimise<Scalar>({iterations}, without, bar.bent.pose, bar_of_slivers);
        return (with.topRows(without.rows()) - without).norm() / (without - bar_of_slivers.bent.mesh.rest).norm();
    };
    for (const double flatness : {1e-6, 7e-10}) EXPECT_LT(difference(0.0, this->enough, flatness), 1e-4) << flatness;
    EXPECT_LT(difference(0.0f, TypeParam::usual, 7e-10), 1e-3);
}

}  // namespace
}  // namespace minimisers_tests
