// Reference: the input comes out again, the residuals equal those of the plain form, and nothing exists that a scene
// does not need.
#include "pbs/solver/batched/batched_projection.hpp"

#include "pbs/solver/project_plain.hpp"
#include "pbs/solver/step_summary.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

namespace batched_projection_tests {
namespace {

using namespace test_support;
using pbs::BatchedProjection;
using pbs::Order;
using pbs::PbsOptions;
using pbs::Positions;
using pbs::Vec3;

template <typename Scalar>
class BatchedProjections : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BatchedProjections, Scalars);

const TwoBoneLimb limb = two_bone_limb({12, 3, 3}, Vec3::UnitZ(), 60.0);  // 208 vertices

PbsOptions ordered_options()
{
    PbsOptions options;
    options.order = Order::ordered;
    options.masses = pbs::Masses::lumped;
    return options;
}

template <typename Scalar>
BatchedProjection<Scalar> projection_of(const PbsOptions& options, const std::vector<bool>& held = {})
{
    return {pbs::make_constraint_set<Scalar>(limb.mesh, limb.binding.distance, {}, options, held), limb.mesh.tets,
            options};
}

template <typename Scalar>
Positions stored(const BatchedProjection<Scalar>& projection, const Vec3& origin)
{
    Positions p(limb.lbs.rows(), 3);
    projection.store(origin, p);
    return p;
}

template <typename Scalar>
std::vector<pbs::Vector3<Scalar>> points_of(const Positions& positions)
{
    std::vector<pbs::Vector3<Scalar>> points;
    for (const auto& row : positions.rowwise()) points.push_back(row.transpose().template cast<Scalar>());
    return points;
}

template <typename Scalar>
void iterate(BatchedProjection<Scalar>& projection)
{
    projection.project_bind_constraints();
    projection.project_stretch_constraints();
    projection.project_volume_constraints();
}

// Exact to the bit in double. In float, the difference is half a spacing of numbers of the size of the body, plus that
// of double at the distance.
TYPED_TEST(BatchedProjections, WhatIsLoadedIsStored)
{
    const Eigen::RowVector3d far(1e4, -1e4, 1e4);
    for (const Eigen::RowVector3d& shift : {Eigen::RowVector3d(0, 0, 0), far}) {
        const Positions p = limb.lbs.rowwise() + shift, q = limb.bind_points.rowwise() + shift;
        const bool is_double = std::is_same_v<TypeParam, double>;
        const Vec3 origin = is_double ? Vec3(Vec3::Zero()) : Vec3(p.colwise().mean());
        auto projection = projection_of<TypeParam>(ordered_options());
        projection.load(p, q, origin);
        // A coordinate relative to the middle, and the coordinate itself: its shift, its distance from the middle,
        // and their sum.
        const double rounding =
            rounding_error_in<float>(1, 1.5) + rounding_error_in<double>(3, shift.cwiseAbs().maxCoeff() + 1.5);
        const double tolerance = is_double ? 0.0 : rounding;
        EXPECT_LE((stored(projection, origin) - p).cwiseAbs().maxCoeff(), tolerance);
    }
}

// Two evaluations of each error in the same precision, with some twenty roundings of terms of order one; root mean
// square over all.
TYPED_TEST(BatchedProjections, ResidualsAreThoseOfThePlainForm)
{
    RandomPoints random(41);
    const double tolerance = rounding_error_in<TypeParam>(2 * 20, 1.0);
    for (const double noise : {0.0, 0.05}) {
        Positions p = limb.lbs;
        for (Eigen::Index i = 0; i < p.rows(); ++i) p.row(i) += random.point(noise).transpose();
        auto projection = projection_of<TypeParam>(ordered_options());
        projection.load(p, limb.bind_points, Vec3::Zero());
        const auto constraints =
            pbs::make_constraint_set<TypeParam>(limb.mesh, limb.binding.distance, {}, ordered_options());
        const pbs::Residuals expected = residuals_of(constraints, points_of<TypeParam>(p),
                                                     points_of<TypeParam>(limb.bind_points)),
                             found = projection.residuals();
        EXPECT_GT(expected.volume_rms, 0.01);
        EXPECT_NEAR(found.stretch_rms, expected.stretch_rms, tolerance * (1.0 + expected.stretch_rms));
        EXPECT_NEAR(found.volume_rms, expected.volume_rms, tolerance * (1.0 + expected.volume_rms));
        EXPECT_NEAR(found.bind_rms_m, expected.bind_rms_m, tolerance * (1.0 + expected.bind_rms_m));
    }
}

// Regions are projected one after the other by the same code in every order: the same bits.
TYPED_TEST(BatchedProjections, RegionsAreThoseOfThePlainForm)
{
    PbsOptions options = ordered_options();
    options.volume_of = pbs::VolumeOf::regions;
    options.region_tets = 40;
    options.k_bind = 0.0;
    auto projection = projection_of<TypeParam>(options);
    const auto constraints = pbs::make_constraint_set<TypeParam>(limb.mesh, limb.binding.distance, {}, options);
    ASSERT_GT(constraints.regions.size(), 5u);
    std::vector<pbs::Vector3<TypeParam>> p = points_of<TypeParam>(limb.lbs), q = points_of<TypeParam>(limb.bind_points);
    projection.load(limb.lbs, limb.bind_points, Vec3::Zero());
    EXPECT_EQ(projection.residuals().volume_rms, residuals_of(constraints, p, q).volume_rms);
    EXPECT_GT(projection.residuals().volume_rms, 1e-3);
    project_region_constraints(constraints, p);
    projection.project_volume_constraints();
    const Positions after = stored(projection, Vec3::Zero());
    for (Eigen::Index i = 0; i < after.rows(); ++i)
        EXPECT_EQ(after.row(i).transpose(), p[i].template cast<double>()) << i;
}

// Bit 0: bind, 1: stretch, 2: volume; a class of stiffness zero is not there.
TYPED_TEST(BatchedProjections, EachClassMovesAlone)
{
    for (int classes = 0; classes < 8; ++classes) {
        PbsOptions options = ordered_options();
        for (double* k : {&options.k_bind, &options.k_stretch, &options.k_volume})
            if (!(classes >> (k == &options.k_bind ? 0 : k == &options.k_stretch ? 1 : 2) & 1)) *k = 0.0;
        auto projection = projection_of<TypeParam>(options);
        projection.load(1.1 * limb.lbs, limb.bind_points, Vec3::Zero());
        EXPECT_EQ(largest(projection.residuals()) > 0.0, classes != 0) << classes;
        for (int which = 0; which < 3; ++which) {
            const Positions before = stored(projection, Vec3::Zero());
            which == 0   ? projection.project_bind_constraints()
            : which == 1 ? projection.project_stretch_constraints()
                         : projection.project_volume_constraints();
            EXPECT_EQ(stored(projection, Vec3::Zero()) != before, bool(classes >> which & 1))
                << which << " of " << classes;
        }
    }
}

TYPED_TEST(BatchedProjections, NotANumberShowsInTheResiduals)
{
    auto projection = projection_of<TypeParam>(ordered_options());
    Positions p = limb.lbs;
    p(17, 1) = std::numeric_limits<double>::quiet_NaN();
    projection.load(p, limb.bind_points, Vec3::Zero());
    EXPECT_TRUE(std::isnan(largest(projection.residuals())));
    iterate(projection);
    EXPECT_TRUE(std::isnan(stored(projection, Vec3::Zero())(17, 1)));
    EXPECT_TRUE(std::isnan(largest(projection.residuals())));
}

// By hand, in f32: an edge has 2 indices, a length and a stiffness; each of 10 vertices goes in and out once per class.
// Sixteen poses share the data of a constraint; each has its own positions (x, y, z) and bind points.
TEST(ProjectionBytes, OfOnePoseAndOfMany)
{
    const pbs::BodySize size{10, 50, 30};
    EXPECT_DOUBLE_EQ(pbs::working_set_bytes({4, 1}, size), 50 * 16 + 30 * 24 + 10 * (20 + 16));
    EXPECT_DOUBLE_EQ(pbs::bytes_per_iteration({4, 1}, size), 50 * 16 + 30 * 24 + 10 * 20 + 3 * 2 * 16 * 10);
    EXPECT_DOUBLE_EQ(pbs::bytes_per_iteration({8, 1}, size), 50 * 24 + 30 * 32 + 10 * 40 + 3 * 2 * 32 * 10);
    EXPECT_DOUBLE_EQ(pbs::bytes_per_iteration({4, 16}, size), 50 * 28 + 30 * 40 + 10 * 8 + 16 * 10 * (12 + 3 * 2 * 12));
    EXPECT_DOUBLE_EQ(pbs::working_set_bytes({4, 16}, size), 50 * 28 + 30 * 40 + 10 * 8 + 16 * 10 * (12 + 12));
}

}  // namespace
}  // namespace batched_projection_tests
