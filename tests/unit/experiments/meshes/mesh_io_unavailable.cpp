// Reference: a build without mesh files states that in its errors.
#include "experiments/meshes/mesh_io.hpp"

#include "tests/unit/experiments/characters/expect_input_error.hpp"

namespace {

TEST(MeshIo, LeftOutSaysWhichOptionBringsItBack)
{
    expect_input_error([] { pbs::read_tet_mesh("limb.msh"); }, "limb.msh: ", "PBS_WITH_MESH_IO");
    EXPECT_THROW(pbs::read_surface("a.obj"), pbs::InputError);
    EXPECT_THROW(pbs::write_vtu("a.vtu", {}, {}, {}), pbs::InputError);
}

}  // namespace
