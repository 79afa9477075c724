// Reference: the rule for the weights of glTF files (finite, 0 or more), on the four weights of an arm, each of which a
// point uses. What else is changed in a document is tested with the rig that is made of it.

#include "experiments/rigs/collada_document.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>
#include <minizip/zip.h>

#include <algorithm>

namespace {

using test_support::ScratchFolder;

std::string arm_of_weights_with(const std::string& part, const std::string& other)
{
    std::string text = test_support::collada_arm();
    EXPECT_NE(text.find(part), std::string::npos) << part;
    return text.replace(text.find(part), part.size(), other);
}

std::string arm_with_weights(const std::string& weights)
{
    return arm_of_weights_with("1 0.5 0.25 0.75", weights);
}

// The message without the path.
void expect_refused(const std::string& text, const std::string& field_and_value)
{
    const ScratchFolder folder;
    const std::string path = folder.file("arm.dae", text);
    expect_input_error(
        [&] { pbs::read_collada_document(path); },
        path + ": controller skin, weight of point " + field_and_value + ": expected a finite number of 0 or more", "");
}

TEST(ColladaDocument, ThatAssimpReadsRightIsLeftAsItIs)
{
    const ScratchFolder folder;
    EXPECT_TRUE(pbs::read_collada_document(folder.file("arm.dae", test_support::collada_arm())).text.empty());
}

void expect_accepted(const std::string& text)
{
    const ScratchFolder folder;
    EXPECT_NO_THROW(pbs::read_collada_document(folder.file("arm.dae", text)));
}

TEST(ColladaWeights, ThatAreNegativeOrNotFiniteAreRefusedWithTheirPoint)
{
    expect_refused(arm_with_weights("1 -0.5 0.25 0.75"), "1 = -0.5");
    for (const std::string weight : {"-0.75", "-1e-400", "nan", "inf", "-inf", "1e400", "half"})
        expect_refused(arm_with_weights("1 0.5 0.25 " + weight), "3 = " + weight);
}

TEST(ColladaWeights, OfZeroOrMoreAndThoseThatNoPointUsesAreAccepted)
{
    for (const char* weight : {"0.75", "+0.75", "0", "-0", "7.5E-1", "1e-400", "3", "0.75 -1"})
        expect_accepted(arm_with_weights("1 0.5 0.25 " + std::string(weight)));
    std::string text = arm_with_weights("1 0.5 0.25 -0.75");
    // the controller is not part of the scene
    expect_accepted(text.replace(text.find("url=\"#skin\""), 11, "url=\"#none\""));
    // What is no XML or no archive is left to the reader.
    for (const std::string& other :
         {std::string("<COLLADA><library_controllers>"), arm_of_weights_with("1 2 1 2</vcount>", "1 2 99 2</vcount>"),
          std::string("PK\x03\x04 nothing")})
        expect_accepted(other);
}

TEST(ColladaWeights, TheirPlaceFollowsTheAccessor)
{
    const std::string accessor = "<accessor source='#weights-array' count='4' stride='1'>";
    const std::string pairs = "<accessor source='#weights-array' count='4' stride='2'>";
    std::string text = arm_of_weights_with(accessor, pairs);
    const std::string weights = "1 0.5 0.25 0.75";
    text.replace(text.find(weights), weights.size(), "1 -9 0.5 -9 0.25 -9 0.75 -9");
    expect_accepted(text);
    text.replace(text.find("0.25 -9"), 7, "-0.2 -9");
    expect_refused(text, "3 = -0.2");
}

// assimp would show the last one for both.
TEST(ColladaGeometries, OfOneIdAreRefused)
{
    const ScratchFolder folder;
    std::string text = test_support::collada_arm();
    const std::size_t begin = text.find("<geometry "), end = text.find("</geometry>") + 11;
    text.insert(end, text.substr(begin, end - begin));
    const std::string path = folder.file("arm.dae", text);
    expect_input_error([&] { pbs::read_collada_document(path); },
                       path + ": geometry = arm: ", "expected one id per geometry");
}

// Points near the origin replace those of a geometry that is far from it.
TEST(ColladaFarFromTheOrigin, IsLeftAsItIsWhereAWordIsNoNumber)
{
    const ScratchFolder folder;
    const auto text_of_arm_that_ends_at = [&](const std::string& word) {
        const std::string far = "1e7 0 0 1e7 2 0 1e7 4 0 1e7 2 " + word;
        return pbs::read_collada_document(folder.file("arm.dae", arm_of_weights_with("1 0 0 1 2 0 1 4 0 2 2 0", far)))
            .text;
    };
    EXPECT_FALSE(text_of_arm_that_ends_at("1.5").empty());
    for (const std::string word : {"1,5", "1.5abc", "1.5-2", "half"})
        EXPECT_TRUE(text_of_arm_that_ends_at(word).empty()) << word;
}

void write_archive(const std::string& path, const std::vector<std::string>& texts)
{
    zipFile archive = zipOpen(path.c_str(), APPEND_STATUS_CREATE);
    ASSERT_TRUE(archive);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const std::string name = std::to_string(i) + ".dae";
        zipOpenNewFileInZip(archive, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                            Z_DEFAULT_COMPRESSION);
        zipWriteInFileInZip(archive, texts[i].data(), static_cast<unsigned>(texts[i].size()));
        zipCloseFileInZip(archive);
    }
    zipClose(archive, nullptr);
}

TEST(ColladaWeights, OfAnArchiveAreChecked)
{
    const ScratchFolder folder;
    const std::string path = folder / "arm.zae";
    write_archive(path, {arm_with_weights("1 0.5 0.25 -0.75")});
    expect_input_error([&] { pbs::read_collada_document(path); },
                       path + ": controller skin, weight of point 3 = -0.75: ", "");
}

TEST(ColladaArchive, IsReadAsTheOneDocumentThatItHas)
{
    const ScratchFolder folder;
    const std::string path = folder / "arm.zae", stepped = arm_of_weights_with("LINEAR LINEAR", "STEP STEP");
    write_archive(path, {stepped});
    const pbs::ColladaDocument document = pbs::read_collada_document(path);
    EXPECT_FALSE(document.text.empty());
    EXPECT_EQ(document.text, pbs::read_collada_document(folder.file("arm.dae", stepped)).text);
    const pbs::Rig rig = pbs::read_rig(path);
    const auto elbow = std::ranges::find(rig.nodes, "elbow", &pbs::RigNode::name) - rig.nodes.begin();
    // it turns by 90 degrees at the second key
    for (const auto& [time_s, cosine] : {std::pair(0.9, 1.0), std::pair(1.0, 0.0)}) {
        const auto nodes = pbs::node_transforms(rig, &rig.animations.at(0), time_s);
        EXPECT_NEAR(nodes.at(static_cast<std::size_t>(elbow)).linear().col(0).normalized().x(), cosine, 1e-6) << time_s;
    }
    write_archive(path, {stepped, test_support::collada_arm()});
    expect_input_error([&] { pbs::read_collada_document(path); },
                       path + ": documents = 2: ", "unpack it, and use the .dae");
}

}  // namespace
