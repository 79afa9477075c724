// Reference: an artificial mesher whose number of vertices is a known power of the cell size.

#include "experiments/meshes/meshing.hpp"
#include "experiments/meshes/meshing_attempts.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/expect_ball.hpp"
#include "tests/support/mesher_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

namespace {

pbs::TetMesh with_vertices(int count)
{
    pbs::TetMesh mesh;
    mesh.rest.setZero(count, 3);
    mesh.tets.setZero(1, 4);
    return mesh;
}

TEST(Count, IsReachedInAFewTriesWhateverThePower)
{
    for (const double power : {-2.0, -2.5, -3.0})
        for (const int wanted : {200, 2000, 200000}) {
            int tries = 0;
            const pbs::TetMesh mesh = pbs::mesh_at_vertex_count(wanted, 0.1, [&](double size) {
                ++tries;
                return with_vertices(static_cast<int>(2.0 * std::pow(size, power)));
            });
            EXPECT_NEAR(double(mesh.rest.rows()), wanted, 0.05 * wanted);
            EXPECT_LE(tries, 5) << power;
        }
}

TEST(Count, TheNearestIsKeptWhereNoSizeReachesItAndASizeThatFailsIsStepped)
{
    const pbs::TetMesh mesh =
        pbs::mesh_at_vertex_count(500, 1.0, [](double size) { return with_vertices(size < 0.5 ? 900 : 400); });
    EXPECT_EQ(mesh.rest.rows(), 400);
    const pbs::TetMesh stepped = pbs::mesh_at_vertex_count(
        500, 1.0, [](double size) { return size > 0.7 ? pbs::TetMesh() : with_vertices(500); });
    EXPECT_EQ(stepped.rest.rows(), 500);
    EXPECT_EQ(pbs::mesh_at_vertex_count(500, 1.0, [](double) { return pbs::TetMesh(); }).tets.rows(), 0);
}

// Reference: the closed forms of the bodies' volumes, and the specification in the header.

constexpr double radius = 0.15;
constexpr double capsule_volume = std::numbers::pi * radius * radius * (2.0 + 4.0 / 3.0 * radius);

void expect_sound(const pbs::TetMesh& mesh, int wanted)
{
    const pbs::Quality quality = pbs::quality_of(mesh);
    test_support::expect_ball(quality);
    EXPECT_GT(pbs::tet_volumes(mesh.rest, mesh.tets).minCoeff(), 0.0);
    EXPECT_GT(quality.min_dihedral_deg, 8.0);
    EXPECT_NEAR(quality.vertices, wanted, 0.1 * wanted);
}

double depth(const pbs::Vec3& p)
{
    return radius - (p - pbs::Vec3(std::clamp(p(0), -1.0, 1.0), 0, 0)).norm();
}

// Each size is meshed once for all tests of a suite.
const pbs::TetMesh& limb_of(int vertices)
{
    static std::map<int, pbs::TetMesh> meshes;
    if (!meshes.contains(vertices)) meshes.emplace(vertices, pbs::mesh_limb(vertices));
    return meshes.at(vertices);
}

TEST(Limb, IsSoundAtTheWantedSizeAndHasTheDefaultsSize)
{
    for (const int vertices : {300, 500, 1000}) expect_sound(limb_of(vertices), vertices);
    const pbs::Quality quality = pbs::quality_of(pbs::mesh_limb(1775));
    EXPECT_NEAR(quality.vertices, 1775, 0.05 * 1775);
    EXPECT_NEAR(quality.tets, 7600, 0.05 * 7600);
}

TEST(Limb, HasItsSkinOnTheCapsule)
{
    const pbs::TetMesh& limb = limb_of(500);
    const std::vector<bool> on_skin = pbs::boundary_vertices(limb.tets, limb.rest.rows());
    for (Eigen::Index i = 0; i < limb.rest.rows(); ++i)
        if (on_skin[std::size_t(i)]) {
            EXPECT_NEAR(depth(limb.rest.row(i)), 0.0, test_support::on_skin_m);
        }
}

// The volume that the facets cut off: the depth under a facet is, to leading order, a quadratic form that vanishes at
// its three corners, whose mean is always 3/4 of its value at the middle. The remainder is of the order depth/radius,
// here 15 % of the cut.
TEST(Limb, HasTheVolumeOfTheCapsuleLessWhatItsFacetsCutOff)
{
    for (const int vertices : {500, 1000}) {
        const pbs::TetMesh& limb = limb_of(vertices);
        const pbs::Triangles boundary = pbs::boundary_of(limb.tets);
        double cut = 0.0;
        for (Eigen::Index f = 0; f < boundary.rows(); ++f) {
            const pbs::Vec3 a = limb.rest.row(boundary(f, 0)), b = limb.rest.row(boundary(f, 1)),
                            c = limb.rest.row(boundary(f, 2));
            cut += 0.75 * depth((a + b + c) / 3.0) * 0.5 * (b - a).cross(c - a).norm();
        }
        const double volume = pbs::tet_volumes(limb.rest, limb.tets).sum();
        EXPECT_GT(cut, 0.0);
        EXPECT_LT(cut, 0.06 * capsule_volume);
        EXPECT_NEAR(volume + cut, capsule_volume, 0.15 * cut);
    }
}

// The faces are flat. A point on them goes through some ten roundings where a segment of up to the bar's length meets a
// plane.
TEST(Bar, IsSoundAtTheWantedSizeAndHasItsExactVolume)
{
    for (const int vertices : {200, 300, 600}) {
        const pbs::TetMesh bar = pbs::mesh_bar(vertices);
        expect_sound(bar, vertices);
        const double of_faces_m = test_support::rounding_error(10, 2.0), area_m2 = 4 * 2.0 * 0.3 + 2 * 0.3 * 0.3;
        EXPECT_NEAR(pbs::tet_volumes(bar.rest, bar.tets).sum(), 2.0 * 0.3 * 0.3,
                    area_m2 * of_faces_m + test_support::volume_error(bar.rest, bar.tets));
        EXPECT_LT((bar.rest.colwise().maxCoeff() - Eigen::RowVector3d(1, 0.15, 0.15)).norm(),
                  std::sqrt(3.0) * of_faces_m);
        EXPECT_LT((bar.rest.colwise().minCoeff() + Eigen::RowVector3d(1, 0.15, 0.15)).norm(),
                  std::sqrt(3.0) * of_faces_m);
    }
}

TEST(BuiltIn, TooFewVerticesAreRefused)
{
    for (const int vertices : {-1, 0, 299}) EXPECT_THROW(pbs::mesh_limb(vertices), pbs::InputError);
    for (const int vertices : {-1, 0, 199}) EXPECT_THROW(pbs::mesh_bar(vertices), pbs::InputError);
}

// Reference: the closed forms of sphere and torus, their topology, and the specification in the header.

using test_support::icosphere;
using test_support::torus;

// Coarse wraps make these tests quick.
pbs::SurfaceMeshing quick(double alpha, double offset, int vertices)
{
    return {.vertices = vertices, .wrap_alpha_m = alpha, .wrap_offset_m = offset, .inside = {}};
}

void expect_refused(const pbs::SurfaceMesh& surface, const pbs::SurfaceMeshing& options, const std::string& begins,
                    const std::string& holds)
{
    expect_input_error([&] { pbs::mesh_surface(surface, options); }, begins, holds);
}

TEST(SurfaceToTets, TheSphereIsABallOfItsVolume)
{
    pbs::SurfaceMeshing options = quick(0.2, 0.01, 500);
    options.inside = {{0, 0, 0}, {0.9, 0, 0}, {0, -0.5, 0.5}};
    const pbs::TetMesh ball = pbs::mesh_surface(icosphere(1.0, 3), options);
    const pbs::Quality quality = pbs::quality_of(ball);
    test_support::expect_ball(quality);
    EXPECT_NEAR(quality.vertices, 500, 50);  // within 10 %, as for the built-in bodies
    EXPECT_GE(quality.min_dihedral_deg, options.min_dihedral_deg);
    EXPECT_GT(pbs::tet_volumes(ball.rest, ball.tets).minCoeff(), 0.0);
    // Skin vertices lie on the wrap, whose vertices are at the offset of 0.01 from the icosphere. Its facets fit in
    // circles of radius alpha and sink by at most 0.2^2 / 2 = 0.02 m, those of the icosphere by 0.006 m: from 0.984
    // to 1.01 m.
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
    test_support::expect_ball(quality, 0);
    // The offset of 0.01 m adds 5 %. The polygons of 20 and 40 sides lack 1.6 % and 0.4 %, and facets that fit in
    // circles of radius alpha, which sink by 0.1^2 / 0.8 = 0.0125 m, lack up to 6 %.
    EXPECT_NEAR(quality.volume_m3, 2.0 * std::numbers::pi * std::numbers::pi * 0.4 * 0.4, 0.08 * 3.2);
}

// A ball of a quarter of the other's size beside it. Facets that fit in circles of radius alpha sink by at most 0.15^2
// / 0.5 = 0.045 m.
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

TEST(SurfaceToTets, WrapsOfAnotherShapeAndPointsOutsideAreRefused)
{
    expect_refused(torus(1.0, 0.4, 40, 20), quick(0.15, 0.02, 300),
                   "Euler number of the wrapped surface = 0: ", "expected 2");
    pbs::SurfaceMeshing options = quick(0.2, 0.02, 200);
    options.inside = {{0, 0, 0}, {0, 0, 3}};
    expect_refused(icosphere(1.0, 2), options, "point 1 asked inside: ", "expected inside the surface");
}

// Asked once too often, the mesher ends as it does where the perturbation has no end.
TEST(SurfaceToTets, APerturbationWithoutEndIsRefusedAfterTheLastAttempt)
{
    pbs::SurfaceMeshing options = quick(0.3, 0.02, 150);
    options.most_questions = 1;
    expect_refused(icosphere(1.0, 1), options,
                   "vertices of the tets = 150: ", "without end to improve flat tets: expected another number");
}

TEST(SurfaceToTets, SmallHolesAreClosedAndOpenSheetsRefused)
{
    pbs::SurfaceMesh sphere = icosphere(1.0, 3);
    sphere.triangles = sphere.triangles.bottomRows(sphere.triangles.rows() - 1).eval();
    EXPECT_EQ(pbs::quality_of(pbs::mesh_surface(sphere, quick(0.25, 0.02, 300))).topology.boundary_euler, 2);
    sphere.triangles = sphere.triangles.topRows(sphere.triangles.rows() / 3).eval();
    expect_refused(sphere, quick(0.1, 0.01, 300), "", "expected 0.5 to 2: a closed or nearly closed surface");
}

TEST(SurfaceToTets, BadInputIsRefused)
{
    const pbs::SurfaceMeshing options = quick(0.2, 0.02, 200);
    pbs::SurfaceMesh flat = icosphere(1.0, 1), not_finite = flat, without_a_point = flat;
    flat.points.col(2).setConstant(1.0 / 3.0);
    not_finite.points(3, 1) = std::numeric_limits<double>::quiet_NaN();
    without_a_point.triangles(2, 2) = 1000;
    expect_refused(flat, options,
                   "enclosed volume [m^3] = ", "expected a closed surface round a volume, neither flat nor open");
    expect_refused({}, options, "triangles = 0: ", "");
    expect_refused(not_finite, options, "", "expected finite coordinates");
    expect_refused(without_a_point, options, "", "expected indices of points");
    expect_refused(icosphere(1.0, 1), quick(0.2, 0.02, 10), "vertices = 10: ", "");
}

// Reference: the mesh itself. Facets lie within a twentieth of the mean edge of its boundary, 0.1 m, which bounds the
// change of the volume.
TEST(OtherTets, FillTheSameBoundaryAndRepeatAndDifferBySeed)
{
    const pbs::TetMesh &limb = limb_of(600), one = pbs::mesh_anew(limb, {.seed = 1}),
                       other = pbs::mesh_anew(limb, {.seed = 2});
    expect_sound(one, static_cast<int>(one.rest.rows()));
    EXPECT_NEAR(static_cast<double>(one.rest.rows()), static_cast<double>(limb.rest.rows()),
                0.2 * static_cast<double>(limb.rest.rows()));
    EXPECT_EQ(pbs::mesh_anew(limb, {.seed = 1}).tets, one.tets);
    EXPECT_NE(other.rest.rows(), one.rest.rows());
    const double volume = pbs::tet_volumes(limb.rest, limb.tets).sum(),
                 area = 2.0 * std::numbers::pi * radius * (2.0 + 2.0 * radius);
    for (const pbs::TetMesh& mesh : {one, other})
        EXPECT_NEAR(pbs::tet_volumes(mesh.rest, mesh.tets).sum(), volume, 0.05 * 0.11 * area);
}

// A facet's circumscribed circle is at most 0.75 of the wanted length in radius, so that no edge is longer than 1.5 of
// it. Where facets are moved to improve the tets, or reach out of the ball, they are larger; half of the ball's radius
// is left out for them.
TEST(OtherTets, HaveAFinerSkinInABall)
{
    const pbs::TetMesh& limb = limb_of(600);
    const pbs::FineBall ball{pbs::Vec3(0.0, radius, 0.0), 0.1, 0.02};
    const pbs::TetMesh fine = pbs::mesh_anew(limb, {.fine = {ball}});
    const pbs::Triangles skin = pbs::boundary_of(fine.tets);
    double longest_m = 0.0;
    for (const auto& face : skin.rowwise())
        for (int k = 0; k < 3; ++k) {
            const pbs::Vec3 a = fine.rest.row(face(k)), b = fine.rest.row(face((k + 1) % 3));
            if (((a + b) / 2.0 - ball.centre).norm() < ball.radius_m / 2.0)
                longest_m = std::max(longest_m, (b - a).norm());
        }
    EXPECT_GT(longest_m, ball.size_m / 2.0);
    EXPECT_LE(longest_m, 1.5 * ball.size_m);
    EXPECT_LT(fine.rest.rows(), 2 * limb.rest.rows());
}

// Otherwise the distance of two solutions does not show the influence of the mesh where it matters most. A disc of the
// ball's radius with triangles of its edge length has pi 0.1^2 / (0.866 0.02^2) = 90 vertices. Where the sizes of the
// seeds were the same, all were the same.
TEST(OtherTets, TakeOtherPointsInABallWithAnotherSeed)
{
    const pbs::TetMesh& limb = limb_of(600);
    const pbs::FineBall ball{pbs::Vec3(0.0, radius, 0.0), 0.1, 0.02};
    std::set<std::array<double, 3>> points[2], own;
    for (const auto& p : limb.rest.rowwise()) own.insert({p(0), p(1), p(2)});
    for (const unsigned seed : {1, 2}) {
        const pbs::TetMesh other = pbs::mesh_anew(limb, {.seed = seed, .fine = {ball}});
        for (const auto& p : other.rest.rowwise())
            if ((p.transpose() - ball.centre).norm() < ball.radius_m && !own.contains({p(0), p(1), p(2)}))
                points[seed - 1].insert({p(0), p(1), p(2)});
    }
    std::vector<std::array<double, 3>> both;
    std::ranges::set_intersection(points[0], points[1], std::back_inserter(both));
    for (const auto& of_seed : points) {
        EXPECT_GT(of_seed.size(), 90u / 2);
        EXPECT_LT(2 * both.size(), of_seed.size());
    }
}

TEST(OtherTets, TetsThatMeetInAnEdgeAloneAreRefused)
{
    pbs::TetMesh two;
    two.rest = pbs::Positions{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
    two.tets = pbs::Tets{{0, 1, 3, 2}, {0, 1, 5, 4}};
    expect_input_error([&] { pbs::mesh_anew(two, {}); }, "tets = 2: ", "expected some with a manifold boundary");
    expect_input_error([] { pbs::mesh_anew({}, {}); }, "tets = 0: ", "");
}

}  // namespace
