// Reference: the constraints that Sec. 3.3-3.6 require, counted by hand.
#include "pbs/solver/constraint_set.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::ConstraintSet;
using pbs::PbsOptions;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});
const Eigen::VectorXd distance = Eigen::VectorXd::LinSpaced(bar.rest.rows(), 0.0, 1.0);

ConstraintSet<double> constraints_of(const PbsOptions& options, const std::vector<bool>& jiggle_zone = {})
{
    return pbs::make_constraint_set<double>(bar, distance, jiggle_zone, options);
}

TEST(ConstraintSet, HasEveryEdgeTetAndVertexInFileOrder)
{
    const ConstraintSet<double> constraints = constraints_of({});
    const pbs::Edges edges = pbs::edges_of(bar.tets);
    ASSERT_EQ(constraints.stretch.size(), std::size_t(edges.rows()));
    for (std::size_t e = 0; e < constraints.stretch.size(); ++e) {
        const auto& [vertex, rest_length, stiffness] = constraints.stretch[e];
        EXPECT_EQ(vertex, (std::array{edges(e, 0), edges(e, 1)}));
        EXPECT_DOUBLE_EQ(rest_length, (bar.rest.row(vertex[0]) - bar.rest.row(vertex[1])).norm());
        EXPECT_EQ(stiffness, 0.2);
    }
    ASSERT_EQ(constraints.volume.size(), 12u);
    for (std::size_t t = 0; t < 12; ++t) {
        EXPECT_EQ(constraints.volume[t].vertex[3], bar.tets(t, 3));
        EXPECT_DOUBLE_EQ(constraints.volume[t].rest_volume, 1.0 / 6.0);
    }
    ASSERT_EQ(constraints.bind.size(), 12u);
    EXPECT_EQ(constraints.bind[11].vertex, 11);
    EXPECT_EQ(constraints.bind[11].rest_distance, 1.0);
    EXPECT_EQ(constraints.inverse_mass, std::vector<double>(12, 1.0));
}

TEST(ConstraintSet, LeavesOutAClassOfStiffnessZero)
{
    PbsOptions options;
    options.k_stretch = 0.0;
    EXPECT_TRUE(constraints_of(options).stretch.empty());
    EXPECT_FALSE(constraints_of(options).volume.empty());
    options = {};
    options.k_volume = 0.0;
    EXPECT_TRUE(constraints_of(options).volume.empty());
    options = {};
    options.k_bind = 0.0;
    EXPECT_TRUE(constraints_of(options).bind.empty());
}

TEST(ConstraintSet, SoftensEdgesWithBothEndsInTheJiggleZone)
{
    PbsOptions options;
    options.jiggle = pbs::Jiggle{0.05};
    std::vector<bool> zone(bar.rest.rows(), false);
    zone[0] = zone[1] = true;
    for (const auto& edge : constraints_of(options, zone).stretch)
        EXPECT_EQ(edge.stiffness, edge.vertex == (std::array{0, 1}) ? 0.05 : 0.2);
    options.jiggle->k_stretch = 0.0;
    EXPECT_EQ(constraints_of(options, zone).stretch.size() + 1, constraints_of({}).stretch.size());
    options.jiggle.reset();
    for (const auto& edge : constraints_of(options, zone).stretch) EXPECT_EQ(edge.stiffness, 0.2);
}

// n projections of the share s leave (1 - s)^n; with Mueller's exponent that is 1 - k for any n. 1 - s goes through three roundings, which
// the power multiplies by n, and the power itself is rounded.
TEST(ConstraintSet, MuellersExponentLeavesTheSameWhateverTheIterations)
{
    PbsOptions options;
    options.stiffness_form = pbs::StiffnessForm::exponent;
    for (const int iterations : {1, 24, 1000})
        for (const double k : {0.0, 0.2, 0.9, 1.0}) {
            options.iterations = iterations;
            EXPECT_NEAR(std::pow(1.0 - pbs::share_removed(k, options), iterations), 1.0 - k,
                        test_support::rounding_error(3 * iterations + 2, 1.0))
                << iterations << ' ' << k;
        }
    options.iterations = 24;
    options.k_stretch = 0.2;
    const auto softer = pbs::make_constraint_set<double>(bar, distance, {}, options);
    EXPECT_DOUBLE_EQ(softer.stretch.front().stiffness, 1.0 - std::pow(0.8, 1.0 / 24.0));
    EXPECT_EQ(softer.volume.front().stiffness, 1.0);
}

TEST(ConstraintSet, LumpedMassesAreRelativeToTheirMean)
{
    PbsOptions options;
    options.masses = pbs::Masses::lumped;
    const ConstraintSet<double> constraints = constraints_of(options);
    double mass = 0.0;
    for (const double w : constraints.inverse_mass) mass += 1.0 / w;
    EXPECT_NEAR(mass, 12.0, test_support::rounding_error(2 * 12 + 3, 12.0));  // the mean and the sum of twelve, and three quotients
    EXPECT_GT(*std::max_element(constraints.inverse_mass.begin(), constraints.inverse_mass.end()), 1.5);
}

TEST(ConstraintSet, HeldVerticesHaveNoInverseMass)
{
    std::vector<bool> held(bar.rest.rows(), false);
    held[3] = true;
    for (const auto masses : {pbs::Masses::unit, pbs::Masses::lumped}) {
        PbsOptions options;
        options.masses = masses;
        const std::vector<double> free = constraints_of(options).inverse_mass;
        const std::vector<double> inverse_mass = pbs::make_constraint_set<double>(bar, distance, {}, options, held).inverse_mass;
        for (std::size_t i = 0; i < free.size(); ++i) EXPECT_EQ(inverse_mass[i], i == 3 ? 0.0 : free[i]);
    }
}

TEST(ConstraintSet, RefusesToHoldWhatIsIntegratedOrHasNoMass)
{
    const std::vector<bool> held(bar.rest.rows(), true);
    EXPECT_NO_THROW(pbs::make_constraint_set<double>(bar, distance, held, {}, held));  // the zone is switched off
    PbsOptions options;
    options.jiggle = pbs::Jiggle{};
    EXPECT_THROW(pbs::make_constraint_set<double>(bar, distance, held, options, held), pbs::InputError);
    options = {};
    options.volume_form = pbs::VolumeForm::labels_relative;
    EXPECT_THROW(pbs::make_constraint_set<double>(bar, distance, {}, options, held), pbs::InputError);
    EXPECT_THROW(pbs::make_constraint_set<double>(bar, distance, {}, {}, std::vector<bool>(3, true)), pbs::InputError);
}

TEST(ConstraintSet, RefusesStiffnessesOutsideZeroToOne)
{
    for (double PbsOptions::*field : {&PbsOptions::k_stretch, &PbsOptions::k_volume, &PbsOptions::k_bind})
        for (const double k : {-0.1, 1.1, std::nan("")}) {
            PbsOptions options;
            options.*field = k;
            EXPECT_THROW(constraints_of(options), pbs::InputError) << k;
        }
    PbsOptions options;
    options.jiggle = pbs::Jiggle{1.5};
    EXPECT_THROW(constraints_of(options), pbs::InputError);
    options = {};
    options.iterations = -1;
    EXPECT_THROW(constraints_of(options), pbs::InputError);
}

TEST(ConstraintSet, RefusesWrongSizes)
{
    EXPECT_THROW(pbs::make_constraint_set<float>(bar, distance.head(3), {}, {}), pbs::InputError);
    EXPECT_THROW(constraints_of({}, std::vector<bool>(3, true)), pbs::InputError);
}

TEST(ConstraintSet, RefusesBadTets)
{
    pbs::TetMesh bad = bar;
    bad.tets(3, 0) = 12;
    EXPECT_THROW(pbs::make_constraint_set<double>(bad, distance, {}, {}), pbs::InputError);
    bad = bar;
    std::swap(bad.tets(3, 0), bad.tets(3, 1));  // mirrored
    EXPECT_THROW(pbs::make_constraint_set<double>(bad, distance, {}, {}), pbs::InputError);
    bad = bar;
    bad.rest.col(2).setZero();  // flat
    EXPECT_THROW(pbs::make_constraint_set<double>(bad, distance, {}, {}), pbs::InputError);
}

TEST(ConstraintSet, AVertexOnItsBoneIsPinnedOrUnbound)
{
    ASSERT_EQ(distance(0), 0.0);  // alone
    PbsOptions options;
    EXPECT_EQ(constraints_of(options).bind.size(), 12u);
    options.bind_on_bone = pbs::BindOnBone::unbound;
    const auto unbound = constraints_of(options).bind;
    ASSERT_EQ(unbound.size(), 11u);
    for (const auto& bind : unbound) EXPECT_NE(bind.vertex, 0);
}

TEST(ConstraintSet, BindInTheJigglingZoneMayHaveAStiffnessOfItsOwn)
{
    std::vector<bool> zone(12, false);
    zone[3] = true;
    PbsOptions options;
    options.k_bind = 0.8;
    options.jiggle = pbs::Jiggle{.k_stretch = 0.1, .k_bind = 0.25};
    for (const auto& bind : constraints_of(options, zone).bind) EXPECT_EQ(bind.stiffness, bind.vertex == 3 ? 0.25 : 0.8);
    options.jiggle->k_bind = 0.0;
    EXPECT_EQ(constraints_of(options, zone).bind.size(), 11u);
    options.jiggle->k_bind.reset();
    for (const auto& bind : constraints_of(options, zone).bind) EXPECT_EQ(bind.stiffness, 0.8);
    options.jiggle->k_bind = 1.5;
    EXPECT_THROW(constraints_of(options, zone), pbs::InputError);
}

}  // namespace
