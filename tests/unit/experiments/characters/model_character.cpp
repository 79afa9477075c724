// Reference: the interface. Each remark is provoked alone on a box of tets with one or two bones.
#include "experiments/characters/model_character.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

// A box from 0 to 1 m whose bones, "a" and "b", are inside.
struct BoxModel {
    TetMesh mesh = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    RiggedBody body;
    Weights artist;

    BoxModel()
    {
        body.skeleton.bones = {{"a", -1, Vec3(0.1, 0.5, 0.5), Vec3(0.4, 0.5, 0.5)},
                               {"b", 0, Vec3(0.4, 0.5, 0.5), Vec3(0.9, 0.5, 0.5)}};
        body.surface = mesh.rest;
        body.triangles = boundary_of(mesh.tets);
        artist.first = {0};
        for (int v = 0; v < mesh.rest.rows(); ++v) {
            artist.bone.push_back(mesh.rest(v, 0) < 0.4 ? 0 : 1);
            artist.weight.push_back(1.0);
            artist.first.push_back(v + 1);
        }
        body.skin = artist;
    }
    RemarkList all_remarks(double distance_m = 0.0) const
    {
        Character character;
        character.mesh = mesh;
        character.surface = embed(body.surface, body.triangles, mesh);
        character.artist = ArtistSkin{.weights = artist, .model = nullptr, .largest_distance_m = distance_m};
        return remarks_on_model(body, character, "a.glb");
    }
    std::vector<std::string> remarks(double distance_m = 0.0) const
    {
        std::vector<std::string> texts;
        for (const Remark& remark : all_remarks(distance_m)) texts.push_back(remark.text);
        return texts;
    }
};

TEST(ModelRemarks, ThoseOfTheReaderComeFirstWithTheFileAndASoundModelHasNone)
{
    BoxModel box;
    EXPECT_TRUE(box.remarks().empty());
    box.body.remarks = {"mesh hat is moved by no joint; it is left out"};
    box.body.notes = {"two joints are named a; one is called a 2"};
    EXPECT_EQ(box.all_remarks(),
              (RemarkList{{Gravity::part_left_out, "a.glb: mesh hat is moved by no joint; it is left out"},
                          {Gravity::information, "a.glb: two joints are named a; one is called a 2"}}));
}

TEST(ModelRemarks, AnExtentBelowFiveCentimetresOrAboveTwentyMetresSpeaksForOtherUnits)
{
    for (const auto& [extent_m, count] :
         {std::pair(0.051, 0u), std::pair(0.049, 1u), std::pair(19.9, 0u), std::pair(170.0, 1u)}) {
        BoxModel box;
        box.body.surface *= extent_m;
        box.mesh.rest *= extent_m;
        for (Bone& bone : box.body.skeleton.bones) {
            bone.head *= extent_m;
            bone.tail *= extent_m;
        }
        const std::vector<std::string> remarks = box.remarks();
        ASSERT_EQ(remarks.size(), count) << extent_m;
        for (const std::string& remark : remarks)
            EXPECT_NE(remark.find("a.glb: unlikely units: the body's largest extent is "), std::string::npos) << remark;
    }
}

TEST(ModelRemarks, ASkeletonOfAnotherSizeThanItsMeshIsNamedAsTheCause)
{
    for (const auto& [scale, is_named] :
         {std::pair(1.0, false), std::pair(1.0 / 16000.0, true), std::pair(1000.0, true), std::pair(0.0, false)}) {
        BoxModel box;
        box.body.skeleton.bones.resize(3, box.body.skeleton.bones.front());
        for (std::size_t b = 0; b < 3; ++b) {
            Bone& bone = box.body.skeleton.bones[b];
            bone.head = scale * Vec3(0.1, 0.1, 0.1 + 0.3 * static_cast<double>(b));
            bone.tail = bone.head + scale * Vec3(0.0, 0.0, 0.1);
        }
        std::string all;
        for (const std::string& remark : box.remarks()) all += remark + "\n";
        EXPECT_EQ(all.find(" times as large as the mesh in the bind pose") != std::string::npos, is_named)
            << scale << all;
        EXPECT_EQ(all.find("unlikely units"), std::string::npos) << all;
    }
}

TEST(ModelRemarks, BonesOutsideTheBodyAreNamed)
{
    BoxModel box;
    box.body.skeleton.bones[1].head = Vec3(2, 2, 2);
    box.body.skeleton.bones[1].tail = Vec3(3, 2, 2);
    EXPECT_EQ(box.remarks(), std::vector<std::string>{"a.glb: 1 of 2 bones lie outside the body: b"});
    BoxModel partly_inside;
    // its middle, from 0.73 to 2.07, is inside up to 1
    partly_inside.body.skeleton.bones[1].tail = Vec3(2.4, 0.5, 0.5);
    EXPECT_TRUE(partly_inside.remarks().empty());
}

TEST(ModelRemarks, AJointThatTheTetsDoNotCarryIsWithoutFlesh)
{
    BoxModel box;
    box.artist.bone.assign(box.artist.bone.size(), 0);
    EXPECT_EQ(box.remarks(),
              std::vector<std::string>{
                  "a.glb: 1 of 2 joints are without flesh, for the tets are too coarse for what they move, and the "
                  "surface alone follows them: b"});
    box.artist = box.body.skin;
    EXPECT_TRUE(box.remarks().empty());
}

TEST(ModelRemarks, TetsFarFromTheSurface)
{
    const BoxModel box;  // with a diagonal of 1.732 m, of which 0.018 m are 1.04 %
    EXPECT_TRUE(box.remarks(0.017).empty());
    EXPECT_EQ(
        box.remarks(0.018),
        std::vector<std::string>{
            "a.glb: the boundary of the tets lies up to 1.04 % of the body's size from the surface of the model"});
}

TEST(ModelRemarks, ASurfaceWithoutVolumeIsALayer)
{
    BoxModel box;
    box.body.surface = (Positions(4, 3) << 0, 0, 0.5, 1, 0, 0.5, 1, 1, 0.5, 0, 1, 0.5).finished();
    box.body.triangles = (Triangles(2, 3) << 0, 1, 2, 0, 2, 3).finished();
    box.body.skin = {.first = {0, 1, 2, 3, 4}, .bone = {0, 1, 1, 0}, .weight = {1, 1, 1, 1}};
    const RemarkList remarks = box.all_remarks();
    ASSERT_EQ(remarks.size(), 1u);
    EXPECT_EQ(remarks[0].gravity, Gravity::results_wrong);
    EXPECT_NE(remarks[0].text.find("a.glb: the surface encloses no volume"), std::string::npos) << remarks[0].text;
}

TEST(ModelRemarks, OfAFileWithoutJointsConcernItsSizeAlone)
{
    BoxModel box;
    box.body.skeleton.bones.clear();
    box.artist = {};
    EXPECT_TRUE(box.remarks().empty());
}

TEST(ModelRemarks, NameAtMostEightBones)
{
    BoxModel box;
    for (int extra = 0; extra < 10; ++extra)
        box.body.skeleton.bones.push_back({"x" + std::to_string(extra), 0, Vec3(5, 5, 5), Vec3(6, 5, 5)});
    EXPECT_TRUE(box.remarks().empty()) << "they move nothing";
    for (std::size_t v = 0; v < box.artist.bone.size(); ++v) box.artist.bone[v] = static_cast<int>(v % 12);
    box.body.skin = box.artist;
    const std::vector<std::string> remarks = box.remarks();
    ASSERT_EQ(remarks.size(), 1u);
    EXPECT_EQ(remarks[0], "a.glb: 10 of 12 bones lie outside the body: x0, x1, x2, x3, x4, x5 and 4 others");
}

}  // namespace
