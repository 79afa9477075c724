// Reference: an independent implementation of the same laws, elements and load steps, which was written earlier and separately with deal.II
// and CHOLMOD: a bar of 3.5 x 1 x 1 m, 14 x 4 x 4 Kuhn-split cubes, P1, E = 1e5 Pa, both ends held, one turned by 180 degrees in ten steps.
// Both stop at a residual of 1e-8 of the forces, after a quadratic last Newton step; values of volume and energy agree to a relative 1e-6.
// Newton may take 1.5 times the iterations of that implementation.
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Vec3;

constexpr double length_m = 3.5, young_pa = 1e5;
constexpr int steps = 10;

struct Expected {
    Model model;
    double poisson;
    int iterations;                                    // total over all steps
    double volume_change_at_90, volume_change_at_180;  // (V - V0) / V0
    double energy_j;                                   // at 180 degrees
    int inverted;                                      // inverted tets at 180 degrees
};

class TwistedBar : public testing::TestWithParam<Expected> {
protected:
    bool at_end(int node) const { return space.node_positions()(node, 0) > length_m - 1e-9; }

    std::vector<bool> held_ends() const
    {
        std::vector<bool> held(space.dofs(), false);
        for (int node = 0; node < space.nodes(); ++node)
            for (int c = 0; c < 3; ++c) held[3 * node + c] = at_end(node) || space.node_positions()(node, 0) < 1e-9;
        return held;
    }

    Eigen::VectorXd turned(double angle) const
    {
        Eigen::VectorXd values = Eigen::VectorXd::Zero(space.dofs());
        for (int node = 0; node < space.nodes(); ++node) {
            if (!at_end(node)) continue;
            const double y = space.node_positions()(node, 1), z = space.node_positions()(node, 2);
            values.segment<3>(3 * node) << 0.0, std::cos(angle) * y - std::sin(angle) * z - y,
                std::sin(angle) * y + std::cos(angle) * z - z;
        }
        return values;
    }

    const SimplexSpace space{test_support::structured_bar({0, -0.5, -0.5}, {length_m, 0.5, 0.5}, {14, 4, 4}), 1};
};

TEST_P(TwistedBar, RepeatsAnIndependentImplementation)
{
    const Expected& expected = GetParam();
    const ElasticPotential flesh(space, expected.model, lame_parameters(young_pa, expected.poisson), Formulation::displacement);
    NewtonMinimiser newton(space, held_ends(), LinearSolver::cholmod);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    const auto volume_change = [&] { return flesh.jacobians(displacement).volume / length_m - 1.0; };
    double at_90 = 0.0;
    int iterations = 0;
    for (int step = 1; step <= steps; ++step) {
        const NewtonSummary summary = newton.minimise({&flesh}, turned(M_PI * step / steps), displacement, {});
        ASSERT_TRUE(summary.converged()) << "step " << step << ": " << name_of(summary.outcome);
        iterations += summary.steps();
        if (2 * step == steps) at_90 = volume_change();
    }
    RecordProperty("iterations", iterations);
    EXPECT_LE(iterations, 1.5 * expected.iterations);
    EXPECT_NEAR(at_90, expected.volume_change_at_90, 1e-6 * std::abs(expected.volume_change_at_90));
    EXPECT_NEAR(volume_change(), expected.volume_change_at_180, 1e-6 * std::abs(expected.volume_change_at_180));
    EXPECT_NEAR(flesh.value(displacement), expected.energy_j, 1e-6 * expected.energy_j);
    EXPECT_EQ(flesh.jacobians(displacement).inverted, expected.inverted);
}

INSTANTIATE_TEST_SUITE_P(
    Laws, TwistedBar,
    testing::Values(Expected{Model::stable_neo_hookean, 0.3, 50, -6.8349804192e-03, -2.8020370874e-02, 1.047788284999e+04, 0},
                    Expected{Model::stable_neo_hookean, 0.45, 50, -1.8702141625e-03, -7.8129832536e-03, 9.696531388558e+03, 0},
                    Expected{Model::stable_neo_hookean, 0.49, 60, -4.2347097354e-04, -1.8853111745e-03, 9.994678023704e+03, 0},
                    Expected{Model::neo_hookean, 0.3, 50, -6.6665240298e-03, -2.6201008159e-02, 1.048922204187e+04, 0},
                    Expected{Model::st_venant_kirchhoff, 0.3, 50, -2.5182813391e-02, -9.8233488282e-02, 1.048159840561e+04, 0},
                    Expected{Model::corotational, 0.3, 50, -1.3929716612e-02, -5.4098614675e-02, 1.034785204164e+04, 0},
                    Expected{Model::linear, 0.3, 10, 2.9200961035e-01, -6.5684811309e-02, 1.100775641600e+05, 32}));

}  // namespace
