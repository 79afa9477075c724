// Reference: volumes in closed form, and the topology of a ball. Tolerances: the roundings of tets' volumes and of their sum. Where
// coordinates are multiples of 1/2 a volume is rounded once, by its division by 6.
#include "reference_fem/verification/problems.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/volume_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Vec3;
using test_support::rounding_error;

double lowest_volume(const pbs::TetMesh& mesh)
{
    return pbs::tet_volumes(mesh.rest, mesh.tets).minCoeff();
}

double volume(const pbs::TetMesh& mesh)
{
    return pbs::tet_volumes(mesh.rest, mesh.tets).sum();
}

void expect_ball(const pbs::TetMesh& mesh)
{
    const pbs::Topology topology = pbs::topology_of(mesh.tets, mesh.rest.rows());
    EXPECT_TRUE(topology.boundary_manifold);
    EXPECT_EQ(topology.boundary_components, 1);
    EXPECT_EQ(topology.boundary_euler, 2);
    EXPECT_EQ(topology.unused_vertices, 0);
}

TEST(StructuredMesh, ABoxIsFilledByEqualTets)
{
    const pbs::TetMesh box = box_mesh({0, -1, 2}, {3, 1, 3}, {3, 2, 2});
    EXPECT_EQ(box.tets.rows(), 6 * 12);
    EXPECT_NEAR(volume(box), 6.0, rounding_error(1 + 6 * 12, 6.0));
    EXPECT_EQ(lowest_volume(box), 0.5 / 6.0);
    expect_ball(box);
    EXPECT_EQ(text_of({3, 2, 2}), "3 x 2 x 2");
}

TEST(StructuredMesh, JitterMovesInnerVerticesOnly)
{
    const pbs::TetMesh even = jittered_cube(4, 0.0), moved = jittered_cube(4, 0.45);
    EXPECT_GT(lowest_volume(moved), 0.0);
    EXPECT_NEAR(volume(moved), 1.0, test_support::volume_error(moved.rest, moved.tets));
    const std::vector<bool> on_boundary = pbs::boundary_vertices(even.tets, even.rest.rows());
    for (Eigen::Index v = 0; v < even.rest.rows(); ++v) EXPECT_EQ(even.rest.row(v) == moved.rest.row(v), on_boundary[v]);
}

TEST(StructuredMesh, AMirroredMeshIsTurnedRightSideOut)
{
    const pbs::TetMesh mirrored = mapped(box_mesh({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), [](const Vec3& p) -> Vec3 {
        return {-p.x(), p.y(), p.z()};
    });
    EXPECT_GT(lowest_volume(mirrored), 0.0);
}

TEST(StructuredMesh, JoinedBoxesShareTheirVertices)
{
    const pbs::TetMesh whole = joined({box_mesh({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), box_mesh({1, 0, 0}, {2, 1, 1}, {2, 2, 2})});
    EXPECT_EQ(whole.rest.rows(), 5 * 3 * 3);
    EXPECT_NEAR(volume(whole), 2.0, rounding_error(1 + 2 * 6 * 8, 2.0));
    expect_ball(whole);
}

}  // namespace
