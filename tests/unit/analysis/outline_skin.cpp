// Reference: prisms over a triangle with sides 3, 4 and 5, cut across; a corner of the outline stands for half of each side that it ends.
#include "analysis/outline_skin.hpp"

#include <gtest/gtest.h>

namespace {

using analysis::share_of_outline;

// Only the sides, from z = -0.9 to 1; vertices 2 i below and 2 i + 1 above corner i.
struct Prisms {
    pbs::Positions positions, outline{3, 3};  // of the first
    pbs::Triangles skin;
};

Prisms prisms(int count)
{
    const double corners[3][2] = {{0, 0}, {4, 0}, {0, 3}};
    Prisms prisms{.positions = pbs::Positions(6 * count, 3), .skin = pbs::Triangles(6 * count, 3)};
    for (int p = 0; p < count; ++p)
        for (int i = 0; i < 3; ++i) {
            const pbs::Vec3 corner(10.0 * p + corners[i][0], corners[i][1], 0.0);
            const int own = 6 * p + 2 * i, next = 6 * p + 2 * ((i + 1) % 3);
            prisms.positions.row(own) = corner - 0.9 * pbs::Vec3::UnitZ();
            prisms.positions.row(own + 1) = corner + pbs::Vec3::UnitZ();
            prisms.skin.row(own) << own, next, next + 1;
            prisms.skin.row(own + 1) << own, next + 1, own + 1;
            if (p == 0) prisms.outline.row(i) = corner;
        }
    return prisms;
}

double share(const Prisms& cut, const std::vector<int>& vertices)
{
    std::vector<bool> chosen(cut.positions.rows());
    for (const int v : vertices) chosen[v] = true;
    return share_of_outline(cut.outline, {pbs::Vec3::Zero(), 3.0 * pbs::Vec3::UnitZ()}, cut.positions, cut.skin, chosen);
}

TEST(OutlineSkin, IsOfTheNearerVertexOfEachEdge)
{
    EXPECT_EQ(share(prisms(1), {0, 2, 4}), 1.0);  // 0.9 below, 1 above
    EXPECT_EQ(share(prisms(1), {1, 3, 5}), 0.0);
}

TEST(OutlineSkin, IsSharedByLength)
{
    EXPECT_DOUBLE_EQ(share(prisms(1), {0}), 3.5 / 12.0);
    EXPECT_DOUBLE_EQ(share(prisms(1), {2}), 4.5 / 12.0);
    EXPECT_DOUBLE_EQ(share(prisms(1), {2, 4}), 8.5 / 12.0);
}

TEST(OutlineSkin, IsNothingOfAnotherPartThatThePlaneCutsToo)
{
    EXPECT_EQ(share(prisms(2), {6, 8, 10}), 0.0);
    EXPECT_EQ(share(prisms(2), {0, 2, 4}), 1.0);
}

TEST(OutlineSkin, WithoutLengthIsAllTheLimbs)
{
    Prisms one = prisms(1);
    one.outline = pbs::Positions(one.outline.topRows(1));
    EXPECT_EQ(share(one, {}), 1.0);
    one.outline.resize(0, 3);
    EXPECT_EQ(share(one, {}), 1.0);
}

}  // namespace
