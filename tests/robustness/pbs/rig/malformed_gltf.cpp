// Reference: the contract of InputError. Each malformed glTF is refused by file, field, value and rule.
#include "pbs/rig/gltf_rig.hpp"

#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>

namespace {

using nlohmann::json;
using test_support::GltfDocument;

struct MalformedGltf {
    const char* name;
    std::function<void(GltfDocument&)> damage;
    std::string begins, holds;  // after the file
};

void PrintTo(const MalformedGltf& malformed, std::ostream* out)
{
    *out << malformed.name;
}

class RefusedGltf : public testing::TestWithParam<MalformedGltf> {};

TEST_P(RefusedGltf, NamesFileFieldValueAndRule)
{
    GltfDocument gltf = test_support::two_joint_document();
    GetParam().damage(gltf);
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("a.gltf", gltf.text());
    expect_input_error([&] { pbs::read_gltf_rig(path); }, path + ": " + GetParam().begins, GetParam().holds);
}

json& primitive(GltfDocument& gltf)
{
    return gltf.json["meshes"][0]["primitives"][0];
}

std::vector<float> points_with(float number)
{
    return {1, 0, 0, 1, number, 0, 1, 4, 0, 2, 2, 0};
}

// Two affine matrices by columns, of which the second one has this linear part on its diagonal.
std::vector<float> two_binds(float second)
{
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1, second, 0, 0, 0, 0, second, 0, 0, 0, 0, second, 0, 0, 0, 0, 1};
}

const float not_a_number = std::numeric_limits<float>::quiet_NaN();
const std::string attributes = "meshes/0/primitives/0/attributes/";

const MalformedGltf malformed_nodes[] = {
    {"version_1", [](auto& gltf) { gltf.json["asset"]["version"] = "1.0"; }, "asset.version = 1.0: ", "expected 2.0"},
    {"draco", [](auto& gltf) { gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
     "extensionsRequired = KHR_draco_mesh_compression: ", "export the model without it"},
    {"own_parent", [](auto& gltf) { gltf.json["nodes"][1]["children"] = {1}; }, "nodes/1/children = 1: ", "one parent per node"},
    {"cycle", [](auto& gltf) { gltf.json["nodes"] = json::parse(R"([{"children": [1]}, {"children": [0]}, {"mesh": 0}])"); },
     "nodes/0: ", "is its own ancestor"},
    {"two_parents", [](auto& gltf) { gltf.json["nodes"][2]["children"] = {1}; }, "nodes/2/children = 1: ", "one parent per node"},
    {"child_out_of_range", [](auto& gltf) { gltf.json["nodes"][1]["children"] = {3}; }, "nodes/1/children = 3: ", "a node of the file"},
    {"rotation_of_zero",
     [](auto& gltf) {
         gltf.json["nodes"][1]["rotation"] = {0, 0, 0, 0};
     },
     "nodes/1/rotation: ", "not zero"},
    {"scene_out_of_range", [](auto& gltf) { gltf.json["scene"] = 1; }, "scene = 1: ", "does not exist"},
    {"node_of_scene_out_of_range", [](auto& gltf) { gltf.json["scenes"][0]["nodes"] = {7}; }, "scenes/0/nodes = 7: ", "a node of the file"},
    {"node_twice_in_scene",
     [](auto& gltf) {
         gltf.json["scenes"][0]["nodes"] = {0, 1, 2, 2};
     },
     "scenes/0/nodes = ", "each node once"},
    {"mesh_out_of_range", [](auto& gltf) { gltf.json["nodes"][2]["mesh"] = 1; }, "nodes/2/mesh = 1: ", "does not exist"},
};
INSTANTIATE_TEST_SUITE_P(Nodes, RefusedGltf, testing::ValuesIn(malformed_nodes), [](const auto& info) { return info.param.name; });

const MalformedGltf malformed_meshes[] = {
    {"no_points", [](auto& gltf) { primitive(gltf)["attributes"].erase("POSITION"); }, attributes + "POSITION: ", "missing"},
    {"point_nan",
     [](auto& gltf) { primitive(gltf)["attributes"]["POSITION"] = gltf.template put<float>("VEC3", points_with(not_a_number)); },
     attributes + "POSITION = 7: ", "expected finite numbers"},
    {"point_infinite",
     [](auto& gltf) { primitive(gltf)["attributes"]["POSITION"] = gltf.template put<float>("VEC3", points_with(1.0F / 0.0F)); },
     attributes + "POSITION = 7: ", "expected finite numbers"},
    {"index_out_of_range",
     [](auto& gltf) {
         primitive(gltf)["indices"] = gltf.template put<std::uint16_t>("SCALAR", {0, 1, 4});
     },
     "meshes/0/primitives/0/indices = 4: ", "expected an index from 0 to 3"},
    {"accessor_out_of_range", [](auto& gltf) { primitive(gltf)["attributes"]["WEIGHTS_0"] = 70; },
     attributes + "WEIGHTS_0 = 70: ", "an accessor of the file"},
    {"indices_out_of_range", [](auto& gltf) { primitive(gltf)["indices"] = 70; }, "no glTF that tinygltf can read: ", "indices"},
    {"points_as_scalars", [](auto& gltf) { primitive(gltf)["attributes"]["POSITION"] = 1; },
     attributes + "POSITION = 1: ", "3 numbers per element"},
    {"no_weights", [](auto& gltf) { primitive(gltf)["attributes"].erase("WEIGHTS_0"); }, attributes + "WEIGHTS_0: ", "missing"},
    {"negative_weight",
     [](auto& gltf) {
         primitive(gltf)["attributes"]["WEIGHTS_0"] = gltf.template put<float>("VEC4", {1, 0, 0, 0, 2, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
     },
     "mesh arm, weight of point 1 = -1: ", "0 or more"},
    {"joint_out_of_range",
     [](auto& gltf) {
         primitive(gltf)["attributes"]["JOINTS_0"] =
             gltf.template put<std::uint8_t>("VEC4", {2, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
     },
     attributes + "JOINTS_0 = 2: ", "expected the number of a joint from 0 to 1"},
    {"fewer_weights_than_points",
     [](auto& gltf) {
         primitive(gltf)["attributes"]["WEIGHTS_0"] = gltf.template put<float>("VEC4", {1, 0, 0, 0});
     },
     attributes + "WEIGHTS_0 = 1: ", "as many as there are points, 4"},
    {"fewer_joints_than_points",
     [](auto& gltf) {
         primitive(gltf)["attributes"]["JOINTS_0"] = gltf.template put<std::uint8_t>("VEC4", {1, 0, 0, 0});
     },
     attributes + "JOINTS_0 = 1: ", "as many as there are points, 4"},
};
INSTANTIATE_TEST_SUITE_P(Meshes, RefusedGltf, testing::ValuesIn(malformed_meshes), [](const auto& info) { return info.param.name; });

const MalformedGltf malformed_skins[] = {
    {"skin_out_of_range", [](auto& gltf) { gltf.json["nodes"][2]["skin"] = 1; }, "skin = 1: ", "does not exist"},
    {"no_joints", [](auto& gltf) { gltf.json["skins"][0]["joints"] = json::array(); }, "", "joint"},
    {"unknown_joint",
     [](auto& gltf) {
         gltf.json["skins"][0]["joints"] = {0, 9};
     },
     "skins/0/joints = 9: ", "a node of the file"},
    {"fewer_matrices_than_joints", [](auto& gltf) { gltf.json["accessors"][4]["count"] = 1; },
     "skins/0/inverseBindMatrices = 1: ", "one per joint"},
    {"matrices_as_vectors", [](auto& gltf) { gltf.json["skins"][0]["inverseBindMatrices"] = 3; },
     "skins/0/inverseBindMatrices = 3: ", "16 numbers per element"},
    {"singular_matrix", [](auto& gltf) { gltf.json["skins"][0]["inverseBindMatrices"] = gltf.template put<float>("MAT4", two_binds(0)); },
     "skins/0/inverseBindMatrices = 1: ", "matrices that can be inverted"},
    {"matrix_nan",
     [](auto& gltf) { gltf.json["skins"][0]["inverseBindMatrices"] = gltf.template put<float>("MAT4", two_binds(not_a_number)); },
     "skins/0/inverseBindMatrices = 7: ", "expected finite numbers"},
};
INSTANTIATE_TEST_SUITE_P(Skins, RefusedGltf, testing::ValuesIn(malformed_skins), [](const auto& info) { return info.param.name; });

}  // namespace
