// Reference: an arm of two joints whose skinned points are computed by hand, as COLLADA and as FBX. assimp computes in single precision: at
// most 64 roundings of numbers of at most 8 of the files' units.
#include "pbs/rig/assimp_rig.hpp"

#include "pbs/rig/rig_pose.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/scalar_rounding.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace {

using namespace pbs;

const double assimp_rounding_m = test_support::rounding_error_in<float>(64, 0.08);

int node_named(const Rig& rig, const std::string& name)
{
    for (std::size_t n = 0; n < rig.nodes.size(); ++n)
        if (rig.nodes[n].name == name) return static_cast<int>(n);
    return -1;
}

Rig rig_in(const std::string& name, const std::string& text)
{
    const test_support::ScratchFolder folder;
    return read_assimp_rig(folder.file(name, text));
}

// Points of the skin [m] by their places in the bind pose, since readers may change their order.
void expect_arm(const Rig& rig, double time_s, const Positions& expected_cm)
{
    ASSERT_EQ(rig.meshes.size(), 1u);
    ASSERT_EQ(rig.meshes[0].points.rows(), 4);
    const Positions bound = rig.unit_m * skinned_points(rig.meshes[0], node_transforms(rig, nullptr, 0.0));
    const RigAnimation* animation = find_animation(rig, "");
    ASSERT_TRUE(animation);
    const Positions posed = rig.unit_m * skinned_points(rig.meshes[0], node_transforms(rig, animation, time_s));
    const Positions places_cm = (Positions(4, 3) << 1, 0, 0, 1, 2, 0, 1, 4, 0, 2, 2, 0).finished();
    for (Eigen::Index p = 0; p < 4; ++p) {
        Eigen::Index found = 0;
        const double distance = (bound.rowwise() - 0.01 * places_cm.row(p)).rowwise().norm().minCoeff(&found);
        EXPECT_LE(distance, assimp_rounding_m) << "at rest, point " << p;
        EXPECT_LE((posed.row(found) - 0.01 * expected_cm.row(p)).norm(), assimp_rounding_m) << "at " << time_s << " s, point " << p;
    }
}

void expect_bent_arm(const Rig& rig)
{
    const double s = std::sqrt(0.5);
    Positions eighth(4, 3), quarter(4, 3);  // of a turn about the elbow at (1, 2, 0)
    eighth << 1, 0, 0, 1, 2, 0, 1 - 2 * s, 2 + 2 * s, 0, 0.25 * 2 + 0.75 * (1 + s), 0.25 * 2 + 0.75 * (2 + s), 0;
    quarter << 1, 0, 0, 1, 2, 0, -1, 2, 0, 0.25 * 2 + 0.75 * 1, 0.25 * 2 + 0.75 * 3, 0;
    expect_arm(rig, 0.5, eighth);
    expect_arm(rig, 1.0, quarter);
    EXPECT_EQ(rig.nodes[std::size_t(node_named(rig, "elbow"))].parent, node_named(rig, "root"));
    EXPECT_EQ(rig.meshes[0].joints.size(), 2u);
    EXPECT_EQ(rig.animations[0].start_s, 0.0);
    EXPECT_NEAR(rig.animations[0].end_s, 1.0, 1e-6);
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) EXPECT_LT(rig.nodes[n].parent, int(n));
}

TEST(AssimpRig, AnArmAsCollada)
{
    expect_bent_arm(rig_in("arm.dae", test_support::collada_arm()));
}

TEST(AssimpRig, TheBindShapeMatrixOfColladaMovesThePointsFirst)
{
    expect_bent_arm(rig_in("arm.dae", test_support::collada_arm(2)));
}

TEST(AssimpRig, AnArmAsFbx)
{
    const Rig rig = rig_in("arm.fbx", test_support::fbx_arm());
    EXPECT_EQ(rig.unit_m, 0.01);
    expect_bent_arm(rig);
}

TEST(AssimpRig, TheUnitOfFbxIsStatedInCentimetres)
{
    std::string text = test_support::fbx_arm();
    const std::string stated = "\"Number\", \"\",1\n}";
    text.replace(text.find(stated), stated.size(), "\"Number\", \"\",2.54\n}");
    EXPECT_NEAR(rig_in("arm.fbx", text).unit_m, 0.0254, 1e-9);
}

TEST(AssimpRig, AnAnimationReplacesTheMatrixOfItsNode)
{
    const Rig rig = rig_in("arm.dae", test_support::collada_arm());
    EXPECT_FALSE(rig.nodes[std::size_t(node_named(rig, "elbow"))].rest.matrix);
    EXPECT_TRUE(rig.nodes[std::size_t(node_named(rig, "root"))].rest.matrix);
}

TEST(AssimpRig, CurvesOfFbxThatAreNotLinearAreARemark)
{
    const auto remarks_with = [](const std::string& flags) {
        std::string text = test_support::fbx_arm();
        text.insert(text.find("KeyTime:"), "KeyAttrFlags: *1 {\na: " + flags + "\n}\n");
        return rig_in("arm.fbx", text).remarks;
    };
    EXPECT_TRUE(remarks_with("24836").empty());
    for (const char* flags : {"2", "264"})
        EXPECT_EQ(remarks_with(flags), std::vector<std::string>{"1 of the 1 curves of animations are constant or cubic between their keys; "
                                                                "they are read as linear there"});
}

TEST(AssimpRig, OfABinaryFbxHasBonesWithWeights)
{
    const std::string path = "/usr/share/assimp/models/FBX/animation_with_skeleton.fbx";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "assimp-testmodels is not installed";
    const Rig rig = read_assimp_rig(path);
    ASSERT_FALSE(rig.meshes.empty());
    for (const RigMesh& mesh : rig.meshes)
        for (int p = 0; p < mesh.skin.vertices(); ++p) {
            double sum = 0.0;
            for (int e = mesh.skin.first[std::size_t(p)]; e < mesh.skin.first[std::size_t(p) + 1]; ++e) sum += mesh.skin.weight[e];
            EXPECT_NEAR(sum, 1.0, 1e-12) << "point " << p << " of " << mesh.name;
        }
    EXPECT_TRUE(std::any_of(rig.meshes.begin(), rig.meshes.end(), [](const RigMesh& mesh) { return mesh.joints.size() > 1; }));
}

}  // namespace
