// Reference: an invariance. The same call gives the same mesh to the bit, whatever was meshed before.
#include "experiments/meshes/meshing.hpp"

#include "tests/support/closed_surfaces.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

void expect_same(const pbs::TetMesh& a, const pbs::TetMesh& b)
{
    EXPECT_EQ(a.rest, b.rest);
    EXPECT_EQ(a.tets, b.tets);
}

TEST(Meshing, OfTheBuiltInBodiesRepeatsToTheBit)
{
    const pbs::TetMesh limb = pbs::mesh_limb(400), bar = pbs::mesh_bar(400);
    expect_same(pbs::mesh_limb(400), limb);
    expect_same(pbs::mesh_bar(400), bar);
}

TEST(Meshing, OfASurfaceRepeatsToTheBit)
{
    const pbs::SurfaceMesh sphere = test_support::icosphere(1.0, 2);
    const pbs::SurfaceMeshing options{.vertices = 250, .wrap_alpha_m = 0.2, .wrap_offset_m = 0.02, .inside = {}};
    const pbs::TetMesh first = pbs::mesh_surface(sphere, options);
    pbs::mesh_limb(300);
    expect_same(pbs::mesh_surface(sphere, options), first);
}

// Lengths are relative to the body, so that only rounding remains: of a chain of at most all points, each placed by
// some hundred operations on those before it. The bound separates that from an absolute length in the code: the
// smallest that a mesher here has, 1e-9 m, would be 1e-6 m on the scale of the body that is 1024 times smaller.
TEST(Meshing, OfASurfaceHasNoUnit)
{
    const pbs::SurfaceMesh sphere = test_support::icosphere(1.0, 2);
    const pbs::SurfaceMeshing options{.vertices = 250, .wrap_alpha_m = 0.25, .wrap_offset_m = 0.03125, .inside = {}};
    const pbs::TetMesh metre = pbs::mesh_surface(sphere, options);
    const double of_chain_m = test_support::rounding_error(100.0 * options.vertices, 1.0 + options.wrap_offset_m);
    for (const double scale : {0.0009765625, 1024.0}) {
        pbs::SurfaceMesh scaled = sphere;
        scaled.points *= scale;
        pbs::SurfaceMeshing scaled_options = options;
        scaled_options.wrap_alpha_m *= scale;
        scaled_options.wrap_offset_m *= scale;
        const pbs::TetMesh mesh = pbs::mesh_surface(scaled, scaled_options);
        EXPECT_EQ(mesh.tets, metre.tets);
        EXPECT_LE((mesh.rest / scale - metre.rest).cwiseAbs().maxCoeff(), of_chain_m);
    }
}

}  // namespace
