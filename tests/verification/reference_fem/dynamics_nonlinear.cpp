// Reference: mechanics (momentum), theory (second order, by refinement of the time step compared with a step eight times finer) and the
// exact motion of the skeleton. The material is stable neo-Hookean flesh at finite rotations.
#include "reference_fem/elastic_body.hpp"

#include "pbs/geometry/input_error.hpp"
#include "reference_fem/dynamics/time_stepper.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include "tests/support/solve_rounding.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;

const pbs::TetMesh bar = test_support::structured_bar({0, -0.1, -0.1}, {0.6, 0.1, 0.1}, {6, 2, 2});

// A bar that flies, rotates and vibrates under gravity; nothing holds it.
class FreeFlight : public testing::TestWithParam<TimeScheme> {
protected:
    struct Momenta {
        Vec3 linear, angular;
    };
    Momenta momenta(const TimeStepper& time) const
    {
        const Eigen::VectorXd momentum = time.mass().times(time.motion().velocity);
        Momenta sum{Vec3::Zero(), Vec3::Zero()};
        for (int node = 0; node < space.nodes(); ++node) {
            const Vec3 p = momentum.segment<3>(3 * node), u = time.motion().displacement.segment<3>(3 * node);
            sum.linear += p;
            sum.angular += Vec3(space.node_positions().row(node).transpose() + u).cross(p);
        }
        return sum;
    }

    struct Flight {
        Momenta before, after;    // initially and after 0.2 s
        double residual_n_s = 0;  // the sum over the steps of h times the residual that Newton's method may leave
    };
    Flight fly(double step_s, const Vec3& gravity)
    {
        const ElasticPotential flesh(space, Model::stable_neo_hookean, lame_parameters(2e4, 0.3), Formulation::displacement);
        const std::vector<bool> free(space.dofs(), false);
        NewtonMinimiser newton(space, free, LinearSolver::cholmod);
        TimeStepper time(space, free, flesh, {.scheme = GetParam(), .density_kg_m3 = density}, newton);
        Eigen::VectorXd u(space.dofs()), v(space.dofs()), weight(space.dofs());
        for (int node = 0; node < space.nodes(); ++node) {
            const Vec3 x = space.node_positions().row(node);
            u.segment<3>(3 * node) = Vec3(0.05 * x.x(), 0.0, 0.1 * x.x() * x.x());
            v.segment<3>(3 * node) = Vec3(1.0, -0.5, 0.2) + Vec3(1.0, 4.0, 3.0).cross(x - Vec3(0.3, 0, 0));
            weight.segment<3>(3 * node) = gravity;
        }
        time.start(u, v);
        const DeadLoad load(time.mass().times(weight));
        Flight flight{.before = momenta(time), .after = {}};
        Eigen::VectorXd guess = u;
        for (int k = 0; k < std::lround(0.2 / step_s); ++k) {
            const LoadPathSummary step = time.advance({&flesh, &load}, {}, step_s, guess, {.relative_tolerance = 1e-10}, {});
            EXPECT_TRUE(step.converged());
            flight.residual_n_s += step_s * 1e-10 * step.steps.back().newton.iterations.back().force_scale_n;
        }
        flight.after = momenta(time);
        return flight;
    }

    const double density = 1000.0;
    const SimplexSpace space{bar, 1};
};

// Internal forces cancel in every step of either scheme, so the momentum changes by m g t. Tolerance: along one axis, the residual r of a
// step adds up to at most sqrt(nodes) |r|, and so does its norm over the axes to sqrt(3 nodes) |r|. By (1 - alpha_m) M da_(n+1) + alpha_m M
// da_n = r, a residual changes the accelerations of all later steps together by r / (1 - 2 alpha_m).
TEST_P(FreeFlight, MomentumChangesByTheWeightAlone)
{
    const Vec3 gravity(0, 0, -9.81);
    const auto [before, after, residual_n_s] = fly(0.02, gravity);
    const Vec3 impulse = density * 0.6 * 0.2 * 0.2 * 0.2 * gravity;
    const double tolerance = std::sqrt(3.0 * space.nodes()) * residual_n_s / (1.0 - 2.0 * GetParam().alpha_m);
    EXPECT_LT((after.linear - before.linear - impulse).norm(), tolerance);
    EXPECT_LT(tolerance, 1e-6 * impulse.norm()) << "a bound that would let a wrong mass pass proves nothing";
}

// How far the order observed at steps of h and h / 2 may be from 2: the error is c h^2 (1 + d), where the next term d is at most (w h)^2
// for a motion of angular frequency w.
double next_order(double angular_frequency_1_s, double h)
{
    const double d = std::pow(angular_frequency_1_s * h, 2);
    return std::log2((1.0 + d) / (1.0 + d / 4.0));
}

// Neither scheme conserves angular momentum (J. Simo, N. Tarnow, ZAMP 43, 1992, construct one that does); the error is of second order. The
// shortest wave of the mesh is two cells long, 0.2 m, and travels at sqrt((lambda + 2 mu) / rho).
TEST_P(FreeFlight, AngularMomentumErrsBySecondOrder)
{
    const auto error = [&](double step_s) {
        const auto [before, after, residual_n_s] = fly(step_s, Vec3::Zero());
        return (after.angular - before.angular).norm() / before.angular.norm();
    };
    const double coarse = error(0.0025), fine = error(0.00125);
    RecordProperty("order", std::to_string(std::log2(coarse / fine)));
    const Lame lame = lame_parameters(2e4, 0.3);
    const double wave_1_s = 2.0 * std::acos(-1.0) / 0.2 * std::sqrt((lame.lambda_pa + 2.0 * lame.mu_pa) / density);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, next_order(wave_1_s, 0.0025)) << coarse << " " << fine;
}

INSTANTIATE_TEST_SUITE_P(Scheme, FreeFlight, testing::Values(newmark(), generalized_alpha(0.8)),
                         [](const auto& info) { return info.param.alpha_f == 0.0 ? "newmark" : "generalized_alpha"; });

// The skeleton turns one end of the bar about its axis with a smooth beginning: theta = 1.5 (1 - cos(3 t)) / 2.
class MovedBar : public testing::TestWithParam<std::tuple<Dynamics, bool>> {
protected:
    Attachment attachment() const
    {
        Attachment held{Positions(0, 3), {}, {}, {}, {}};
        if (by_springs()) {
            held.spring_points = resting_points();
            held.spring_stiffness = Eigen::VectorXd::Constant(held.spring_points.rows(), 2e3);
            return held;
        }
        for (int t = 0; t < bar.tets.rows(); ++t) {
            const auto corners = bar.tets.row(t);
            if (std::all_of(corners.begin(), corners.end(), [](int v) { return bar.rest(v, 0) < 0.1 + 1e-9; }))
                held.prescribed_tets.push_back(t);
        }
        return held;
    }

    static Positions resting_points()
    {
        Positions points(5, 3);
        points << 0.05, 0, 0, 0.05, 0.05, 0, 0.05, 0, 0.05, 0.05, -0.05, 0, 0.05, 0, -0.05;
        return points;
    }

    Targets targets(double t) const
    {
        const double angle = 0.75 * (1.0 - std::cos(3.0 * t));
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix().transpose();
        return {by_springs() ? Positions(resting_points() * turn) : Positions(0, 3), bar.rest * turn, {}};
    }

    // The vertices after 0.8 s [m].
    Positions end(int steps) const
    {
        ElasticBody body(bar,
                         {.element_order = 1,
                          .young_pa = 2e4,
                          .poisson = 0.3,
                          .dynamics = std::get<0>(GetParam()),
                          .rayleigh_mass_1_s = 0.5,
                          .rayleigh_stiffness_s = 0.01,
                          .newton = {.relative_tolerance = 1e-10}},
                         attachment());
        const double h = 0.8 / steps;
        for (int k = 0; k < steps; ++k)
            EXPECT_TRUE(body.advance([&](double fraction) { return targets((k + fraction) * h); }, {0, 0, -1}, h).converged());
        return body.positions();
    }

    bool by_springs() const { return std::get<1>(GetParam()); }
};

// The skeleton excites the first twist of the free 0.5 m, with a quarter of a wave of speed sqrt(mu / rho). A reference that is eight times
// finer than the finest has an error of 1/64 of that, which changes the order by log2((1 + 1/64) / (1 + 1/256)) = 0.02.
TEST_P(MovedBar, ConvergesWithSecondOrder)
{
    const Positions reference = end(320);
    const double coarse = (end(20) - reference).norm(), fine = (end(40) - reference).norm();
    RecordProperty("order", std::to_string(std::log2(coarse / fine)));
    const double twist_1_s = std::acos(-1.0) / 2.0 / 0.5 * std::sqrt(lame_parameters(2e4, 0.3).mu_pa / 1000.0);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, next_order(twist_1_s, 0.04) + 0.02);
}

INSTANTIATE_TEST_SUITE_P(Attachment, MovedBar,
                         testing::Combine(testing::Values(Dynamics::newmark, Dynamics::generalized_alpha), testing::Bool()),
                         [](const auto& info) {
                             return std::string(std::get<0>(info.param) == Dynamics::newmark ? "newmark" : "generalized_alpha") +
                                    (std::get<1>(info.param) ? "_springs" : "_prescribed");
                         });

class Body : public testing::Test {
protected:
    ElasticBody body(const ElasticOptions& options) const
    {
        Attachment held{Positions(0, 3), {}, {0, 1, 2, 3, 4, 5}, {}, {}};
        return {bar, options, held};
    }
    static Targets rest(double) { return {Positions(0, 3), bar.rest, {}}; }
};

TEST_F(Body, AtRestStaysAtRestToTheBit)
{
    for (const Model model : {Model::linear, Model::corotational, Model::stable_neo_hookean}) {
        ElasticBody resting =
            body({.model = model, .element_order = 2, .dynamics = Dynamics::generalized_alpha, .rayleigh_stiffness_s = 0.1});
        for (int k = 0; k < 3; ++k) ASSERT_TRUE(resting.advance(rest, Vec3::Zero(), 0.01).converged());
        EXPECT_EQ(resting.positions(), bar.rest);
        EXPECT_EQ(resting.kinetic_energy_j(), 0.0);
    }
}

TEST_F(Body, AfterASolveIsAtRest)
{
    ElasticBody hanging = body({.element_order = 1, .dynamics = Dynamics::newmark});
    const Vec3 gravity(0, 0, -1);
    const LoadPathSummary path = hanging.solve(rest, gravity);
    ASSERT_TRUE(path.converged());
    const Positions equilibrium = hanging.positions();
    for (int k = 0; k < 10; ++k) ASSERT_TRUE(hanging.advance(rest, gravity, 0.01).converged());
    // Newton's method leaves a residual of at most 1e-8 F, a displacement of at most 1e-8 F / min|eigenvalue of K|; the sag is small enough
    // for the stiffness K at rest. A force that is suddenly applied moves a vibrating body by at most twice as much. There are two: what
    // the solution for the equilibrium leaves, and what the time steps leave.
    const Spectrum stiffness = test_support::spectrum_of(bar, {.element_order = 1}, {Positions(0, 3), {}, {0, 1, 2, 3, 4, 5}, {}, {}});
    const double force_n = path.steps.back().newton.iterations.back().force_scale_n;
    const double tolerance = 4.0 * NewtonOptions().relative_tolerance * force_n / stiffness.smallest;
    EXPECT_LT((hanging.positions() - equilibrium).norm(), tolerance);
    EXPECT_LT(tolerance, 1e-4 * (equilibrium - bar.rest).norm()) << "a bound that would let a vibration pass proves nothing";
}

TEST_F(Body, QuasiStaticHasNoStepInTime)
{
    ElasticBody resting = body({.element_order = 1});
    EXPECT_THROW(resting.advance(rest, Vec3::Zero(), 0.01), pbs::InputError);
    EXPECT_EQ(resting.kinetic_energy_j(), 0.0);
}

TEST_F(Body, RefusesAStepThatIsNotPositiveAndABodyWithoutMass)
{
    ElasticBody resting = body({.element_order = 1, .dynamics = Dynamics::newmark});
    for (const double step_s : {0.0, -0.01}) EXPECT_THROW(resting.advance(rest, Vec3::Zero(), step_s), pbs::InputError);
    EXPECT_THROW(body({.element_order = 1, .density_kg_m3 = 0.0, .dynamics = Dynamics::newmark}), pbs::InputError);
    EXPECT_NO_THROW(body({.element_order = 1, .density_kg_m3 = 0.0}));
}

}  // namespace
