// Reference: the closed forms of sphere and torus, their topology, and the specification in the header.
#include "pbs/geometry/meshing.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/quality.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "tests/support/closed_surfaces.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using test_support::icosphere;
using test_support::torus;

// Coarse wraps make these tests quick.
pbs::SurfaceMeshing quick(double alpha, double offset, int vertices)
{
    pbs::SurfaceMeshing options;
    options.vertices = vertices;
    options.wrap_alpha_m = alpha;
    options.wrap_offset_m = offset;
    return options;
}

std::string refusal(const pbs::SurfaceMesh& surface, const pbs::SurfaceMeshing& options)
{
    try {
        pbs::mesh_surface(surface, options);
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(SurfaceToTets, TheSphereIsABallOfItsVolume)
{
    pbs::SurfaceMeshing options = quick(0.2, 0.01, 500);
    options.inside = {{0, 0, 0}, {0.9, 0, 0}, {0, -0.5, 0.5}};
    const pbs::TetMesh ball = pbs::mesh_surface(icosphere(1.0, 3), options);
    const pbs::Quality quality = pbs::quality_of(ball);
    EXPECT_TRUE(quality.topology.boundary_manifold);
    EXPECT_EQ(quality.topology.boundary_euler, 2);
    EXPECT_EQ(quality.topology.components, 1);
    EXPECT_NEAR(quality.vertices, 500, 50);  // within 10 %, as for the built-in bodies
    EXPECT_GE(quality.min_dihedral_deg, options.min_dihedral_deg);
    EXPECT_GT(pbs::tet_volumes(ball.rest, ball.tets).minCoeff(), 0.0);
    // Skin vertices lie on the wrap, whose vertices are at the offset of 0.01 from the icosphere. Its facets fit in circles of radius alpha
    // and sink by at most 0.2^2 / 2 = 0.02 m, those of the icosphere by 0.006 m: from 0.984 to 1.01 m.
    const std::vector<bool> on_skin = pbs::boundary_vertices(ball.tets, ball.rest.rows());
    for (Eigen::Index i = 0; i < ball.rest.rows(); ++i)
        if (on_skin[std::size_t(i)]) {
            EXPECT_NEAR(ball.rest.row(i).norm(), 0.997, 0.013);
        }
    EXPECT_NEAR(quality.volume_m3, 4.0 / 3.0 * std::numbers::pi, 0.06 * 4.0);  // facets of the 500 vertices: some 3 %
}

TEST(SurfaceToTets, TheTorusKeepsItsHandleWhenAsked)
{
    pbs::SurfaceMeshing options = quick(0.1, 0.01, 600);
    options.boundary_euler = 0;
    const pbs::Quality quality = pbs::quality_of(pbs::mesh_surface(torus(1.0, 0.4, 40, 20), options));
    EXPECT_TRUE(quality.topology.boundary_manifold);
    EXPECT_EQ(quality.topology.boundary_euler, 0);
    // The offset of 0.01 m adds 5 %. The polygons of 20 and 40 sides lack 1.6 % and 0.4 %, and facets that fit in circles of radius alpha,
    // which sink by 0.1^2 / 0.8 = 0.0125 m, lack up to 6 %.
    EXPECT_NEAR(quality.volume_m3, 2.0 * std::numbers::pi * std::numbers::pi * 0.4 * 0.4, 0.08 * 3.2);
}

// A ball of a quarter of the other's size beside it. Facets that fit in circles of radius alpha sink by at most 0.15^2 / 0.5 = 0.045 m.
TEST(SurfaceToTets, ASmallPartBesideALargeOneIsKept)
{
    pbs::SurfaceMesh both = icosphere(1.0, 2);
    const pbs::SurfaceMesh small = icosphere(0.25, 2);
    const Eigen::Index first = both.points.rows(), triangles = both.triangles.rows();
    both.points.conservativeResize(first + small.points.rows(), 3);
    both.points.bottomRows(small.points.rows()) = small.points.rowwise() + Eigen::RowVector3d(1.6, 0, 0);
    both.triangles.conservativeResize(triangles + small.triangles.rows(), 3);
    both.triangles.bottomRows(small.triangles.rows()) = small.triangles.array() + static_cast<int>(first);
    pbs::SurfaceMeshing options = quick(0.15, 0.01, 400);
    options.boundary_euler.reset();
    options.is_closed = options.is_one_piece = false;
    const pbs::TetMesh mesh = pbs::mesh_surface(both, options);
    EXPECT_EQ(pbs::quality_of(mesh).topology.components, 2);
    EXPECT_NEAR(mesh.rest.col(0).maxCoeff(), 1.84, 0.05);
}

TEST(SurfaceToTets, TheTorusIsRefusedAsABall)
{
    const std::string words = refusal(torus(1.0, 0.4, 40, 20), quick(0.15, 0.02, 300));
    EXPECT_NE(words.find("Euler number of the wrapped surface = 0: expected 2"), std::string::npos) << words;
}

TEST(SurfaceToTets, APointOutsideIsRefusedByNumber)
{
    pbs::SurfaceMeshing options = quick(0.2, 0.02, 200);
    options.inside = {{0, 0, 0}, {0, 0, 3}};
    const std::string words = refusal(icosphere(1.0, 2), options);
    EXPECT_NE(words.find("point 1 asked inside: expected inside the surface"), std::string::npos) << words;
}

TEST(SurfaceToTets, SmallHolesAreClosedAndOpenSheetsRefused)
{
    pbs::SurfaceMesh sphere = icosphere(1.0, 3);
    sphere.triangles = sphere.triangles.bottomRows(sphere.triangles.rows() - 1).eval();
    EXPECT_EQ(pbs::quality_of(pbs::mesh_surface(sphere, quick(0.25, 0.02, 300))).topology.boundary_euler, 2);
    sphere.triangles = sphere.triangles.topRows(sphere.triangles.rows() / 3).eval();
    const std::string words = refusal(sphere, quick(0.1, 0.01, 300));
    EXPECT_NE(words.find("expected 0.5 to 2: a closed or nearly closed surface"), std::string::npos) << words;
}

TEST(SurfaceToTets, ASurfaceWithoutAVolumeIsRefusedByIt)
{
    pbs::SurfaceMesh flat = icosphere(1.0, 1);
    flat.points.col(2).setConstant(1.0 / 3.0);
    const std::string words = refusal(flat, quick(0.2, 0.02, 200));
    EXPECT_EQ(words.rfind("enclosed volume [m^3] = ", 0), 0u) << words;
    EXPECT_NE(words.find("expected a closed surface round a volume, neither flat nor open"), std::string::npos) << words;
}

TEST(SurfaceToTets, BadInputIsRefused)
{
    const pbs::SurfaceMeshing options = quick(0.2, 0.02, 200);
    EXPECT_NE(refusal({}, options).find("triangles = 0"), std::string::npos);
    pbs::SurfaceMesh sphere = icosphere(1.0, 1);
    sphere.points(3, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal(sphere, options).find("expected finite coordinates"), std::string::npos);
    sphere = icosphere(1.0, 1);
    sphere.triangles(2, 2) = 1000;
    EXPECT_NE(refusal(sphere, options).find("expected indices of points"), std::string::npos);
    EXPECT_NE(refusal(icosphere(1.0, 1), quick(0.2, 0.02, 10)).find("vertices = 10"), std::string::npos);
}

}  // namespace
