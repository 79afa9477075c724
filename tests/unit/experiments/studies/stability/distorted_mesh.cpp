// Reference: the heights and lengths of the tets themselves.
#include "experiments/studies/stability/distorted_mesh.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using experiments::Defect;

const pbs::TetMesh mesh = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 0.0).mesh;

double smallest_volume_kept(const pbs::TetMesh& spoilt)
{
    return (pbs::tet_volumes(spoilt.rest, spoilt.tets).array() / pbs::tet_volumes(mesh.rest, mesh.tets).array()).minCoeff();
}

int moved_vertices(const pbs::TetMesh& spoilt)
{
    return static_cast<int>(((spoilt.rest - mesh.rest).rowwise().norm().array() > 0.0).count());
}

TEST(DistortedMesh, NoneChangesNothing)
{
    EXPECT_EQ(experiments::distorted(mesh, Defect::none, 1e-3).rest, mesh.rest);
}

// A tet with a vertex at the share s of its height has s of its volume; so does one whose edge is shortened to s of its length towards one
// corner. The corners of a thin tet stay in place, and no other tet is as thin. Kuhn tets of cells of width b = 0.075 m across have heights
// of at least b / sqrt 2, and the place of a vertex goes through six roundings of each coordinate of a metre at most. A volume goes through
// ten roundings of products of three edges, of at most five times its size.
TEST(DistortedMesh, TheThinnestTetKeepsTheWantedShareOfItsVolume)
{
    for (const Defect defect : {Defect::slivers, Defect::needles})
        for (const double thinness : {1e-1, 1e-3, 1e-6})
            EXPECT_NEAR(smallest_volume_kept(experiments::distorted(mesh, defect, thinness)), thinness,
                        test_support::rounding_error(6 * std::sqrt(3.0), 1.0) * std::sqrt(2.0) / 0.075 +
                            test_support::rounding_error(2 * 10 * 5, 1.0));
}

TEST(DistortedMesh, MovesATwentiethOfTheVerticesAtMostAndAtLeastOne)
{
    for (const Defect defect : {Defect::slivers, Defect::needles}) {
        const int moved = moved_vertices(experiments::distorted(mesh, defect, 1e-3));
        EXPECT_GT(moved, 0);
        EXPECT_LE(moved, static_cast<int>(0.05 * static_cast<double>(mesh.rest.rows())));
    }
}

TEST(DistortedMesh, TurnsNoTetInsideOut)
{
    for (const Defect defect : {Defect::slivers, Defect::needles}) {
        const pbs::TetMesh spoilt = experiments::distorted(mesh, defect, 1e-6);
        EXPECT_GT(pbs::tet_volumes(spoilt.rest, spoilt.tets).minCoeff(), 0.0);
    }
}

TEST(DistortedMesh, IsTheSameEveryTime)
{
    EXPECT_EQ(experiments::distorted(mesh, Defect::slivers, 1e-3).rest, experiments::distorted(mesh, Defect::slivers, 1e-3).rest);
}

}  // namespace
