// Reference: a build without mesh files states that in its errors.
#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

namespace {

TEST(MeshIo, LeftOutSaysWhichOptionBringsItBack)
{
    try {
        pbs::read_tet_mesh("limb.msh");
        FAIL();
    } catch (const pbs::InputError& error) {
        EXPECT_EQ(std::string(error.what()).rfind("limb.msh: ", 0), 0u) << error.what();
        EXPECT_NE(std::string(error.what()).find("PBS_WITH_MESH_IO"), std::string::npos) << error.what();
    }
    EXPECT_THROW(pbs::read_surface("a.obj"), pbs::InputError);
    EXPECT_THROW(pbs::write_vtu("a.vtu", {}, {}, {}), pbs::InputError);
}

}  // namespace
