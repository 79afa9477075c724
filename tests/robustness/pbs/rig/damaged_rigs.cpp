// Reference: the contract of InputError. A rig of any format that ends early or has a damaged byte is read, or refused by the file's name.
#include "pbs/rig/rig_reader.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

// Reads the file; an InputError has to name it. Returns whether it was read.
bool is_read(const std::string& path)
{
    try {
        pbs::read_rig(path);
        return true;
    } catch (const pbs::InputError& error) {
        EXPECT_EQ(std::string(error.what()).rfind(path, 0), 0u) << error.what();
        return false;
    }
}

class DamagedRig : public testing::TestWithParam<const char*> {
protected:
    static std::string text()
    {
        const std::string extension = GetParam();
        if (extension == "dae") return test_support::collada_arm();
        return extension == "fbx" ? test_support::fbx_arm() : test_support::two_joint_document().text();
    }
    std::string file(const std::string& content) const { return folder.file(std::string("a.") + GetParam(), content); }

    const test_support::ScratchFolder folder;
};

TEST_P(DamagedRig, ThatEndsEarlyIsRefusedByName)
{
    EXPECT_TRUE(is_read(file(text())));
    for (const double share : {0.1, 0.5, 0.9}) EXPECT_FALSE(is_read(file(text().substr(0, std::size_t(share * double(text().size()))))));
}

TEST_P(DamagedRig, WithADamagedByteIsReadOrRefusedByName)
{
    for (std::size_t at = 7; at < text().size(); at += text().size() / 24) {
        std::string content = text();
        content[at] = '\x7f';
        is_read(file(content));
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedRig, testing::Values("gltf", "dae", "fbx"));

void expect_arm_refused(std::string text, const std::string& part, const std::string& damaged, const std::string& name,
                        const std::string& holds)
{
    const test_support::ScratchFolder folder;
    ASSERT_NE(text.find(part), std::string::npos) << part;
    text.replace(text.find(part), part.size(), damaged);
    const std::string path = folder.file(name, text);
    expect_input_error([&] { pbs::read_rig(path); }, path, holds);
}

TEST(MalformedCollada, IsRefusedByName)
{
    const std::string arm = test_support::collada_arm();
    expect_arm_refused(arm, "root elbow", "root wrist", "a.dae", "");
    expect_arm_refused(arm, "<v>0 0 0 1 1 1 1 0 0 2 1 3", "<v>0 0 0 1 1 1 1 0 0 2", "a.dae", "");
    expect_arm_refused(arm, "0 1 3 1 2 3", "0 1 3 1 2 9", "a.dae", "");
    expect_arm_refused(arm, "</mesh>", "", "a.dae", "");
}

// assimp would leave them out without a message.
TEST(MalformedCollada, WeightsThatAreNegativeOrNotNumbersAreRefused)
{
    for (const std::string weight : {"-0.75", "nan"})
        expect_arm_refused(test_support::collada_arm(), "0.25 0.75", "0.25 " + weight, "a.dae",
                           "controller skin, weight of point 3 = " + weight + ": expected a finite number of 0 or more");
}

// On these files assimp 5.2.5 reads beyond its memory, recurses without end, and calls abort(). Its own process contains that.
TEST(FilesOnWhichAssimpBreaksDown, AreRefusedByName)
{
    expect_arm_refused(test_support::collada_arm(), "stride='3'", "stride='2147483647'", "a.dae", "");
    expect_arm_refused(test_support::fbx_arm(), "C: \"OO\",4,3", "C: \"OO\",4,4\nC: \"OO\",4,3", "a.fbx", "");
    expect_arm_refused(test_support::fbx_arm(), "a: 1,2,3", "a: 1,1003,3", "a.fbx", "");
}

TEST(MalformedFbx, IsRefusedByName)
{
    const std::string arm = test_support::fbx_arm();
    expect_arm_refused(arm, "a: 0.5,1,0.75", "a: 0.5,1,-0.75", "a.fbx", "0 or more");
    expect_arm_refused(arm, "FBXVersion: 7400", "FBXVersion: 400", "a.fbx", "");
    expect_arm_refused(arm, "Connections:  {", "Connections:  ", "a.fbx", "");
}

}  // namespace
