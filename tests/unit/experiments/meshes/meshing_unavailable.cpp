// Reference: a build without meshing states that in its errors.
#include "experiments/meshes/meshing.hpp"

#include "tests/unit/experiments/characters/expect_input_error.hpp"

namespace {

TEST(Meshing, LeftOutSaysWhichOptionBringsItBack)
{
    expect_input_error([] { pbs::mesh_limb(1775); }, "limb: ", "PBS_WITH_CGAL");
    EXPECT_THROW(pbs::mesh_surface({}, {}), pbs::InputError);
    EXPECT_THROW(pbs::points_inside({}, {}, {}), pbs::InputError);
}

}  // namespace
