// Reference: the volumes of a box and of single tets, by hand; the gradient by an eps sweep. Tolerances: roundings are counted as in
// projection_rounding.hpp, over all triangles of the surface.
#include "pbs/constraints/region_volume.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/eps_sweep.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace test_support;
using pbs::RegionVolumeConstraint;
using pbs::Vec3;
using Points = std::vector<Vec3>;

const pbs::TetMesh bar = structured_bar({0, 0, 0}, {2, 1, 1}, {2, 2, 2});
const auto box = pbs::make_region_volume_constraint<double>(pbs::boundary_of(bar.tets), bar.rest, 1.0);
const std::vector<double> unit(box.vertex.size(), 1.0);
// A volume is a sum over the triangles, each with some twenty roundings of products of two edges and a distance, of at most 6 m^3 here.
const double rounding_m3 = rounding_error(20.0 * double(box.triangle.size()), 6.0);

Points at_rest()
{
    Points p;
    for (const int v : box.vertex) p.push_back(bar.rest.row(v));
    return p;
}

Points disturbed(unsigned seed, double size_m)
{
    RandomPoints random(seed);
    Points p = at_rest();
    for (Vec3& point : p) point += random.point(size_m);
    return p;
}

Points projected(const RegionVolumeConstraint<double>& constraint, const std::vector<double>& w, Points p)
{
    Points g;
    project(constraint, w, p, g);
    return p;
}

Eigen::VectorXd stacked(const Points& p)
{
    return Eigen::VectorXd::Map(p.front().data(), 3 * Eigen::Index(p.size()));
}

Points unstacked(const Eigen::VectorXd& x)
{
    Points p;
    for (Eigen::Index i = 0; i < x.size(); i += 3) p.emplace_back(x.segment<3>(i));
    return p;
}

TEST(RegionVolume, IsTheVolumeOfTheBoxWhoseInteriorVertexDoesNotEnter)
{
    EXPECT_NEAR(box.rest_volume, 2.0, rounding_m3);
    EXPECT_EQ(box.vertex.size() + 1, std::size_t(bar.rest.rows()));
    Points twice_as_long = at_rest();
    for (Vec3& p : twice_as_long) p.x() *= 2.0;
    EXPECT_NEAR(value(box, twice_as_long), 2.0, rounding_m3);
}

TEST(RegionVolume, OfOneTetIsItsVolumeConstraint)
{
    pbs::TetMesh tet = bar;
    tet.tets = bar.tets.row(0).eval();
    const auto region = pbs::make_region_volume_constraint<double>(pbs::boundary_of(tet.tets), bar.rest, 0.4);
    const pbs::VolumeConstraint<double> alone{{}, region.rest_volume, 0.4};
    RandomPoints random(2);
    Points p(4), g;
    for (int i = 0; i < 4; ++i) p[i] = Vec3(bar.rest.row(tet.tets(0, i))) + random.point(0.2);
    Points of_region(4);
    for (int i = 0; i < 4; ++i) of_region[std::ranges::find(region.vertex, tet.tets(0, i)) - region.vertex.begin()] = p[i];
    const Points before = of_region;
    EXPECT_NEAR(value(region, of_region), value(alone, p[0], p[1], p[2], p[3]), rounding_m3);
    project(region, {1, 1, 1, 1}, of_region, g);
    project(alone, 1.0, 1.0, 1.0, 1.0, p[0], p[1], p[2], p[3]);
    for (int i = 0; i < 4; ++i) {
        const std::size_t at = std::ranges::find(region.vertex, tet.tets(0, i)) - region.vertex.begin();
        EXPECT_GT((of_region[at] - before[at]).norm(), 1e-4);
        EXPECT_LT((of_region[at] - p[i]).norm(), rounding_error(100, 1.0));  // some forty roundings each, of a well-shaped tet
    }
}

TEST(RegionVolume, GradientByEpsSweep)
{
    for (unsigned trial = 0; trial < 10; ++trial) {
        const Points p = disturbed(trial, 0.2);
        RandomPoints random(100 + trial);
        Points direction(p.size());
        for (Vec3& d : direction) d = random.point(1.0);
        const double slope = stacked(gradient(box, p)).dot(stacked(direction));
        expect_slope_by_eps_sweep([](const Eigen::VectorXd& x) { return value(box, unstacked(x)); }, stacked(p), stacked(direction), slope,
                                  1.0);
    }
}

// Gradients of an invariant under shifts and turns add up to zero, and so do their moments; corrections w g with masses 1 / w then conserve
// both momenta. Each of them is a sum over three corners of every triangle.
TEST(RegionVolume, ProjectionConservesLinearAndAngularMomentum)
{
    Points before = disturbed(7, 0.2);
    for (Vec3& p : before) p *= 1.2;  // so that there is volume to lose
    std::vector<double> w;
    RandomPoints random(8);
    for (std::size_t i = 0; i < before.size(); ++i) w.push_back(random.number(0.25, 4.0));
    const Points after = projected(box, w, before);
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    double moved = 0.0;
    for (std::size_t i = 0; i < w.size(); ++i) {
        const Vec3 momentum = (after[i] - before[i]) / w[i];
        linear += momentum;
        angular += before[i].cross(momentum);
        moved += momentum.norm();
    }
    ASSERT_GT(moved, 1e-2);
    const double rounding = rounding_error(double(w.size()) * 4.0 * 2.5, 4.0);  // positions up to 2.5 m, over w of 0.25, and their sums
    EXPECT_LT(linear.norm(), rounding);
    EXPECT_LT(angular.norm(), 2.5 * rounding);
}

// As VolumeConstraint.StiffnessIsTheShareOfTheErrorRemoved: what is left is of second order in the error.
TEST(RegionVolume, StiffnessIsTheShareOfTheErrorRemoved)
{
    const Points p = disturbed(9, 1e-5);
    const double before = value(box, p);
    for (const double k : {0.0, 0.25, 0.5, 1.0}) {
        RegionVolumeConstraint<double> soft = box;
        soft.stiffness = k;
        EXPECT_NEAR(value(box, projected(soft, unit, p)) / before, 1.0 - k, 10.0 * std::abs(before) + 2.0 * rounding_m3 / std::abs(before));
    }
}

TEST(RegionVolume, HeldVerticesStay)
{
    std::vector<double> w = unit;
    w[3] = w[5] = 0.0;
    const Points before = disturbed(10, 0.2), after = projected(box, w, before);
    for (std::size_t i = 0; i < w.size(); ++i) EXPECT_EQ(after[i] == before[i], w[i] == 0.0) << i;
    EXPECT_EQ(projected(box, std::vector<double>(unit.size(), 0.0), before), before);
}

TEST(RegionVolume, RegionCollapsedToALineOrAPointStays)
{
    Points line = at_rest(), point = at_rest();
    for (Vec3& p : line) p = p.x() * Vec3(0.3, 0.1, 0.7);
    for (Vec3& p : point) p = Vec3(0.1, 0.2, 0.3);
    EXPECT_EQ(projected(box, unit, line), line);
    EXPECT_EQ(projected(box, unit, point), point);
}

TEST(RegionVolume, FlattenedRegionIsInflatedAndAMirroredOneTurnedBack)
{
    Points flat = at_rest(), mirrored = at_rest();
    for (Vec3& p : flat) p.z() *= 1e-3;
    for (Vec3& p : mirrored) p.z() *= -1.0;
    EXPECT_GT(value(box, projected(box, unit, flat)), value(box, flat));
    EXPECT_GT(value(box, projected(box, unit, mirrored)), value(box, mirrored));
}

}  // namespace
