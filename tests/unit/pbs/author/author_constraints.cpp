// The projections of the published code. Reference: the rules in author_solver.hpp, by hand, and pbs/constraints.
#include "pbs/author/author_solver.hpp"
#include "pbs/constraints/stretch.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::AuthorStiffness;
using Points = std::vector<pbs::Vector3<double>>;

const AuthorStiffness all_one = {1.0, 1.0, 1.0, 1.0, pbs::smallest_gradient2};
// its volume is 1/6, and its squared gradients add up to 6
const Points tet = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

double volume_of(const Points& x)
{
    return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6.0;
}

// The volume after a projection towards rest_volume.
double projected_volume(const Points& from, double rest_volume, const AuthorStiffness& k)
{
    Points x = from;
    project(pbs::AuthorVolume{{0, 1, 2, 3}, rest_volume}, k, x);
    return volume_of(x);
}

// The error eps / 6 is removed up to the second order, eps^2: the corner p1 moves by the sum of three gradients, so
// that the tet's corner vectors change by at most eps / 6 each times 2, and a product of them by less than eps^2.
TEST(AuthorVolume, RemovesASixthOfTheErrorWithStiffnessOneAndAllOfItWithSix)
{
    const AuthorStiffness six = {1.0, 1.0, 6.0, 6.0, pbs::smallest_gradient2};
    for (const double eps : {1e-2, 1e-3, 1e-4}) {
        const double rest = (1.0 + eps) / 6.0;
        EXPECT_NEAR(rest - projected_volume(tet, rest, all_one), 5.0 / 6.0 * eps / 6.0, eps * eps);
        EXPECT_NEAR(rest - projected_volume(tet, rest, six), 0.0, eps * eps);
    }
}

TEST(AuthorVolume, OfAnInvertedTetHasAStiffnessOfItsOwn)
{
    const Points inverted = {tet[0], tet[2], tet[1], tet[3]};
    const AuthorStiffness inverted_alone = {0.0, 0.0, 1.0, 0.0, pbs::smallest_gradient2};
    EXPECT_GT(projected_volume(inverted, 1.0 / 6.0, inverted_alone), volume_of(inverted));
    EXPECT_EQ(projected_volume(tet, 1.0, inverted_alone), volume_of(tet));
    const AuthorStiffness others_alone = {0.0, 0.0, 0.0, 1.0, pbs::smallest_gradient2};
    EXPECT_EQ(projected_volume(inverted, 1.0 / 6.0, others_alone), volume_of(inverted));
}

// The sum of squared gradients of the tet scaled by s is 6 s^4.
TEST(AuthorVolume, BelowTheThresholdIsLeftOut)
{
    for (const double threshold_over_sum : {0.99, 1.01}) {
        const double scale = std::pow(pbs::smallest_gradient2 / threshold_over_sum / 6.0, 0.25);
        Points small = tet;
        for (auto& point : small) point *= scale;
        EXPECT_EQ(projected_volume(small, 2.0 * volume_of(small), all_one) == volume_of(small),
                  threshold_over_sum > 1.0);
    }
}

TEST(AuthorVolume, CollapsedToALineOrAPointStays)
{
    for (const Points& collapsed : {Points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, Points(4, {1, 2, 3})}) {
        Points x = collapsed;
        project(pbs::AuthorVolume{{0, 1, 2, 3}, 1.0}, {1.0, 1.0, 1.0, 1.0, 0.0}, x);
        EXPECT_EQ(x, collapsed);
    }
}

TEST(AuthorStretch, IsThatOfThePaper)
{
    for (const double rest_length : {2.0, 8.0}) {
        Points x = {{1, 2, 3}, {1, 5, 7}}, expected = x;
        project(pbs::AuthorStretch{{0, 1}, rest_length}, all_one, x);
        project(pbs::StretchConstraint<double>{{0, 1}, rest_length, 1.0}, 1.0, 1.0, expected[0], expected[1]);
        // Either takes some 10 roundings of at most 8.
        for (int end : {0, 1}) EXPECT_LT((x[end] - expected[end]).norm(), test_support::rounding_error(20, 8.0));
    }
}

TEST(AuthorStretch, HasAStiffnessForEachSign)
{
    struct Case {
        double k_compression, k_stretch, rest_length;
        Points expected;
    };
    for (const auto& [k_compression, k_stretch, rest_length, expected] : {Case{1.0, 0.0, 2.0, {{0, 0, 0}, {4, 0, 0}}},
                                                                          {0.0, 0.5, 2.0, {{0.5, 0, 0}, {3.5, 0, 0}}},
                                                                          {0.5, 0.0, 8.0, {{-1, 0, 0}, {5, 0, 0}}}}) {
        Points x = {{0, 0, 0}, {4, 0, 0}};
        project(pbs::AuthorStretch{{0, 1}, rest_length}, {k_compression, k_stretch, 1.0, 1.0, 0.0}, x);
        EXPECT_EQ(x, expected);
    }
    Points without_length(2, {1, 2, 3});
    project(pbs::AuthorStretch{{0, 1}, 2.0}, all_one, without_length);
    EXPECT_EQ(without_length, Points(2, {1, 2, 3}));
}

TEST(AuthorBind, MovesHalfOfTheWayToTheDistanceFromTheSegment)
{
    const std::vector<pbs::BoneSegment> bones = {{{0, 0, 0}, {4, 0, 0}}, {{1, 1, 1}, {1, 1, 1}}};
    struct Case {
        const char* name;
        pbs::Vector3<double> from;
        int bone;
        double distance;
        pbs::Vector3<double> to;
    };
    for (const auto& [name, from, bone, distance, to] :
         {Case{"beside the bone", {1, 4, 0}, 0, 2.0, {1, 3, 0}}, Case{"too near", {1, 0, 4}, 0, 8.0, {1, 0, 6}},
          Case{"beyond the tail", {8, 0, 0}, 0, 2.0, {7, 0, 0}},
          Case{"beyond the head", {-4, 0, 0}, 0, 2.0, {-3, 0, 0}},
          Case{"a vertex on its bone stays", {1, 0, 0}, 0, 2.0, {1, 0, 0}},
          Case{"a bone without length is its head", {1, 1, 5}, 1, 2.0, {1, 1, 4}}}) {
        Points x = {from};
        project(pbs::AuthorBind{0, bone, distance}, bones, all_one, x);
        EXPECT_EQ(x[0], to) << name;
    }
}

}  // namespace
