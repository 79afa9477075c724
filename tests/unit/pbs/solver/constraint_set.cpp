// Reference: the constraints that Sec. 3.3-3.6 require, counted by hand.
#include "pbs/solver/constraint_set.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace constraint_set_tests {
namespace {

using pbs::ConstraintSet;
using pbs::PbsOptions;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});
const Eigen::VectorXd distance = Eigen::VectorXd::LinSpaced(bar.rest.rows(), 0.0, 1.0);

ConstraintSet<double> constraints_of(const PbsOptions& options, const std::vector<bool>& jiggle_zone = {},
                                     const pbs::TetMesh& mesh = bar)
{
    return pbs::make_constraint_set<double>(mesh, distance, jiggle_zone, options);
}

using Change = void (*)(PbsOptions&);

PbsOptions with(Change change)
{
    PbsOptions options;
    change(options);
    return options;
}

std::vector<bool> only(const std::vector<int>& vertices)
{
    std::vector<bool> zone(bar.rest.rows(), false);
    for (const int v : vertices) zone[v] = true;
    return zone;
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

TEST(ConstraintSet, SoftensEdgesWithBothEndsInTheJiggleZone)
{
    PbsOptions options;
    options.jiggle = pbs::Jiggle{0.05};
    const std::vector<bool> zone = only({0, 1});
    for (const auto& edge : constraints_of(options, zone).stretch)
        EXPECT_EQ(edge.stiffness, edge.vertex == (std::array{0, 1}) ? 0.05 : 0.2);
    options.jiggle->k_stretch = 0.0;
    EXPECT_EQ(constraints_of(options, zone).stretch.size() + 1, constraints_of({}).stretch.size());
    options.jiggle.reset();
    for (const auto& edge : constraints_of(options, zone).stretch) EXPECT_EQ(edge.stiffness, 0.2);
}

// n projections of the share s leave (1 - s)^n; with Mueller's exponent that is 1 - k for any n. 1 - s goes through
// three roundings, which the power multiplies by n, and the power itself is rounded.
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

TEST(ConstraintSet, RegionsTakeThePlaceOfTetsOrFollowThem)
{
    PbsOptions options;
    options.k_volume = 0.5;
    options.region_tets = 6;
    EXPECT_TRUE(constraints_of(options).regions.empty());
    options.volume_of = pbs::VolumeOf::regions;
    const ConstraintSet<double> of_regions = constraints_of(options);
    EXPECT_TRUE(of_regions.volume.empty());
    double volume = 0.0;
    for (const auto& region : of_regions.regions) {
        EXPECT_EQ(region.stiffness, 0.5);
        volume += region.rest_volume;
    }
    // of twelve tets' faces, some twenty roundings each
    EXPECT_NEAR(volume, 2.0, test_support::rounding_error(12 * 20, 2.0));
    options.volume_of = pbs::VolumeOf::tets_and_regions;
    EXPECT_EQ(constraints_of(options).volume.size(), 12u);
    EXPECT_EQ(constraints_of(options).regions.size(), of_regions.regions.size());
    options.k_volume = 0.0;
    EXPECT_TRUE(constraints_of(options).regions.empty());
}

// 1 / (1 + 4 (2 / 1)^2) at twice the length of an edge of k = 1 / 5, by hand; the formula goes through five roundings.
TEST(ConstraintSet, StiffnessByLengthFallsWithTheSquareOfTheLength)
{
    EXPECT_EQ(pbs::stiffness_at_length(0.2, 0.7, 0.0), 0.2) << "a length of zero asks for no scaling";
    const double rounding = test_support::rounding_error(5, 1.0);
    EXPECT_NEAR(pbs::stiffness_at_length(0.2, 1.0, 1.0), 0.2, rounding);
    EXPECT_NEAR(pbs::stiffness_at_length(0.2, 2.0, 1.0), 1.0 / 17.0, rounding);
    EXPECT_NEAR(pbs::stiffness_at_length(0.2, 0.5, 1.0), 0.5, rounding);
    for (const double k : {0.0, 1.0}) EXPECT_EQ(pbs::stiffness_at_length(k, 3.0, 1.0), k);

    for (const auto& edge : constraints_of(with([](PbsOptions& o) { o.k_stretch_length_m = 1.0; })).stretch)
        EXPECT_EQ(edge.stiffness, pbs::stiffness_at_length(0.2, edge.rest_length, 1.0));
}

// A chain of length 1 m between two held points, displaced along itself by a sine: the mode decays at the rate k h^2
// pi^2 / 2 per sweep, the diffusion that the formula keeps. A sweep moves every point by two shares one after the
// other, whose product, of relative size k, and the mode's (pi h)^2 / 12 are left out of that rate.
double decay_per_sweep(int edges, double k_stretch_length_m)
{
    const double h = 1.0 / edges, k = pbs::stiffness_at_length(0.02, h, k_stretch_length_m);
    constexpr double amplitude = 1e-6;
    std::vector<pbs::Vec3> p;
    for (int i = 0; i <= edges; ++i) p.emplace_back(i * h + amplitude * std::sin(M_PI * i * h), 0, 0);
    const auto middle = [&] { return p[edges / 2].x() - 0.5; };
    constexpr int sweeps = 100;
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (int e = 0; e < edges; ++e)
            project(pbs::StretchConstraint<double>{{e, e + 1}, h, k}, e == 0 ? 0.0 : 1.0, e + 1 == edges ? 0.0 : 1.0,
                    p[e], p[e + 1]);
    return -std::log(middle() / amplitude) / sweeps;
}

TEST(ConstraintSet, StiffnessByLengthGivesTheSameMaterialOnAFinerMesh)
{
    const double coarse = decay_per_sweep(8, 1.0 / 8), fine = decay_per_sweep(16, 1.0 / 8),
                 unscaled = decay_per_sweep(16, 0.0);
    const double larger_share = pbs::stiffness_at_length(0.02, 1.0 / 16, 1.0 / 8);
    EXPECT_NEAR(fine / coarse, 1.0, larger_share + std::pow(M_PI / 8, 2) / 12.0 + 2.0 / 8)
        << "2 / 8: the end edges move one point alone";
    EXPECT_NEAR(unscaled / coarse, 0.25, 0.1) << "the control: k alone makes the finer mesh four times softer";
}

TEST(ConstraintSet, LumpedMassesAreRelativeToTheirMean)
{
    const ConstraintSet<double> constraints =
        constraints_of(with([](PbsOptions& o) { o.masses = pbs::Masses::lumped; }));
    double mass = 0.0;
    for (const double w : constraints.inverse_mass) mass += 1.0 / w;
    // the mean and the sum of twelve, and three quotients
    EXPECT_NEAR(mass, 12.0, test_support::rounding_error(2 * 12 + 3, 12.0));
    EXPECT_GT(*std::max_element(constraints.inverse_mass.begin(), constraints.inverse_mass.end()), 1.5);
}

TEST(ConstraintSet, HeldVerticesHaveNoInverseMass)
{
    const std::vector<bool> held = only({3});
    for (const auto masses : {pbs::Masses::unit, pbs::Masses::lumped}) {
        PbsOptions options;
        options.masses = masses;
        const std::vector<double> free = constraints_of(options).inverse_mass;
        const std::vector<double> inverse_mass =
            pbs::make_constraint_set<double>(bar, distance, {}, options, held).inverse_mass;
        for (std::size_t i = 0; i < free.size(); ++i) EXPECT_EQ(inverse_mass[i], i == 3 ? 0.0 : free[i]);
    }
}

TEST(ConstraintSet, RefusesToHoldWhatIsIntegratedOrHasNoMass)
{
    const std::vector<bool> held(bar.rest.rows(), true);
    const auto made = [&](Change change, const std::vector<bool>& zone, const std::vector<bool>& of) {
        pbs::make_constraint_set<double>(bar, distance, zone, with(change), of);
    };
    EXPECT_NO_THROW(made([](PbsOptions&) {}, held, held));  // the zone is switched off
    EXPECT_THROW(made([](PbsOptions& o) { o.jiggle = pbs::Jiggle{}; }, held, held), pbs::InputError);
    EXPECT_THROW(made([](PbsOptions& o) { o.volume_form = pbs::VolumeForm::labels_relative; }, {}, held),
                 pbs::InputError);
    EXPECT_THROW(made([](PbsOptions&) {}, {}, std::vector<bool>(3, true)), pbs::InputError);
}

TEST(ConstraintSet, RefusesOptionsOutOfRange)
{
    for (double PbsOptions::*field : {&PbsOptions::k_stretch, &PbsOptions::k_volume, &PbsOptions::k_bind})
        for (const double k : {-0.1, 1.1, std::nan("")}) {
            PbsOptions options;
            options.*field = k;
            EXPECT_THROW(constraints_of(options), pbs::InputError) << k;
        }
    const Change refused[] = {
        [](PbsOptions& o) { o.jiggle = pbs::Jiggle{1.5}; },
        [](PbsOptions& o) { o.jiggle = pbs::Jiggle{.k_stretch = 0.1, .k_bind = 1.5}; },
        [](PbsOptions& o) { o.iterations = -1; },
        [](PbsOptions& o) { o.region_tets = 0; },
        [](PbsOptions& o) { o.k_stretch_length_m = -1.0; },
        [](PbsOptions& o) { o.k_stretch_length_m = std::nan(""); },
        [](PbsOptions& o) { o.k_stretch_length_m = INFINITY; },
        [](PbsOptions& o) { o.volume_of = pbs::VolumeOf::regions, o.sleep = true; },
        [](PbsOptions& o) { o.volume_of = pbs::VolumeOf::regions, o.volume_form = pbs::VolumeForm::sign; }};
    for (const Change& change : refused)
        EXPECT_THROW(constraints_of(with(change)), pbs::InputError) << &change - refused;
}

TEST(ConstraintSet, RefusesWrongSizesAndBadTets)
{
    EXPECT_THROW(pbs::make_constraint_set<float>(bar, distance.head(3), {}, {}), pbs::InputError);
    EXPECT_THROW(constraints_of({}, std::vector<bool>(3, true)), pbs::InputError);
    pbs::TetMesh outside = bar, mirrored = bar, flat = bar;
    outside.tets(3, 0) = 12;
    std::swap(mirrored.tets(3, 0), mirrored.tets(3, 1));
    flat.rest.col(2).setZero();
    for (const pbs::TetMesh& bad : {outside, mirrored, flat})
        EXPECT_THROW(constraints_of({}, {}, bad), pbs::InputError);
}

// It is recognised by its distance from the bone, also where the bind to the blended position has no distance.
TEST(ConstraintSet, AVertexOnItsBoneIsPinnedOrUnbound)
{
    ASSERT_EQ(distance(0), 0.0);  // alone
    PbsOptions options;
    EXPECT_EQ(constraints_of(options).bind.size(), 12u);
    options.bind_on_bone = pbs::BindOnBone::unbound;
    const auto unbound = constraints_of(options).bind;
    ASSERT_EQ(unbound.size(), 11u);
    for (const auto& bind : unbound) EXPECT_NE(bind.vertex, 0);
    options.bind_to = pbs::BindTo::blended_position;
    const auto to_position = constraints_of(options).bind;
    ASSERT_EQ(to_position.size(), 11u);
    for (const auto& bind : to_position) EXPECT_EQ(bind.rest_distance, 0.0);
}

TEST(ConstraintSet, BindInTheJigglingZoneMayHaveAStiffnessOfItsOwn)
{
    const std::vector<bool> zone = only({3});
    PbsOptions options;
    options.k_bind = 0.8;
    options.jiggle = pbs::Jiggle{.k_stretch = 0.1, .k_bind = 0.25};
    for (const auto& bind : constraints_of(options, zone).bind)
        EXPECT_EQ(bind.stiffness, bind.vertex == 3 ? 0.25 : 0.8);
    options.jiggle->k_bind = 0.0;
    EXPECT_EQ(constraints_of(options, zone).bind.size(), 11u);
    options.jiggle->k_bind.reset();
    for (const auto& bind : constraints_of(options, zone).bind) EXPECT_EQ(bind.stiffness, 0.8);
}

}  // namespace
}  // namespace constraint_set_tests
