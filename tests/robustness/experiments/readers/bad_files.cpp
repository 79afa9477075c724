// Reference: the contract of InputError: file, line, field, value and rule. Each bad file is a sound one with one
// change. Files of every format that the program refuses are in tests/support/bad_*.toml; here are those whose defects
// only the readers know.
#include "tests/support/file_readers.hpp"

#include "tests/support/scratch_folder.hpp"

#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include <filesystem>

namespace readers {
namespace {

using nlohmann::json;
using test_support::ScratchFolder;

// `at`: what is replaced in the text; a path in the document of a glTF file, with a JSON value (none: it is removed);
// none: all of it.
struct BadFile {
    std::string name, reader, at, by, begins, holds;  // begins: behind the file
    std::string file = {};                            // its name, if it is not the usual one
};

void PrintTo(const BadFile& bad, std::ostream* out)
{
    *out << bad.name;
}

std::string content_of(const BadFile& bad)
{
    const std::string text = sound(reader_named(bad.reader).text);
    if (bad.at.empty()) return bad.by;
    if (bad.at.front() != '/') return replaced(text, bad.at, bad.by);
    json document = json::parse(text);
    const json::json_pointer place(bad.at);
    if (bad.by.empty())
        document.at(place.parent_pointer()).erase(place.back());
    else
        document[place] = json::parse(bad.by);
    return document.dump();
}

class RefusedFile : public testing::TestWithParam<BadFile> {};

TEST_P(RefusedFile, NamesFileLineFieldValueAndRule)
{
    const Reader& reader = reader_named(GetParam().reader);
    const ScratchFolder folder;
    if (!reader.beside.empty()) folder.file(reader.beside, sound(reader.text_beside));
    const std::string path =
        folder.file(GetParam().file.empty() ? reader.file : GetParam().file, content_of(GetParam()));
    const std::string answer = answer_of(reader, path);
    EXPECT_TRUE(answer.starts_with(path + GetParam().begins)) << answer;
    EXPECT_NE(answer.find(GetParam().holds), std::string::npos) << answer;
}

const BadFile bad_meshes[] = {
    {"gmsh_surface_alone", "gmsh", "1 4 2 0 1 1 2 3 4", "1 2 2 0 1 1 2 3", "", "expected at least one tetrahedron"},
    {"gmsh_pyramid", "gmsh", "1 4 2 0 1 1 2 3 4", "1 7 2 0 1 1 2 3 4 1", "", "pyramid"},
    {"vtk_surface_alone", "vtk", "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10", "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5", "",
     "expected at least one tetrahedron"},
    {"vtk_pyramid", "vtk", "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10", "CELLS 1 6\n5 0 1 2 3 0\nCELL_TYPES 1\n14", "",
     "vtkPyramid"},
    {"no_extension", "vtk", "", "0 0 0\n", "", "expected a tet mesh", "xyz"},
    {"gmsh_by_another_name", "gmsh", "", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n", ": ", "$EndNodes is missing",
     "a.vtk"},
    {"tetgen_no_tets", "tetgen_tets", "0 0 1 2 3\n", "", ":1: tet: ", "truncated"},
    {"tetgen_quadratic", "tetgen_tets", "1 4 0\n0 0 1 2 3", "1 10 0\n0 0 1 2 3 4 5 6 7 8 9", ":1: nodes per tet", ""},
    {"tetgen_word", "tetgen_points", "1 1 0 0", "1 1 x 0", ":3: point", ""},
    {"tetgen_number", "tetgen_points", "1 1 0 0", "7 1 0 0", ":3: point = 7", ""},
    {"tobj_two_coordinates", "tobj", "v 0 0 0", "v 0 0", ":1: v = v 0 0: ", "expected 3 numbers"},
    {"tobj_corner_not_whole", "tobj", "t 0 1 2 3", "t 0 1 2 2.5",
     ":5: t = 2.5: ", "expected the number of a vertex, from 0"},
    {"no_surface", "obj", "", "$MeshFormat\n2.2 0 8\n", ": format of the content = .msh: ", "expected a surface"},
    {"points_and_lines", "obj", "", "v 0 0 0\nv 1 0 0\nl 1 2\n", ": ", ""},
    {"triangles_without_area", "obj", "", "v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\nf 1 1 1\n",
     ": triangles = 2: ", "expected one whose three corners differ"},
#ifdef PBS_WITH_CGAL
    {"polygon_without_area", "off", "4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n",
     "6 5 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n2 0 0\n3 0 0\n4 0 1 4 5\n", ": face 0: ", "expected an area"},
#endif
};
INSTANTIATE_TEST_SUITE_P(Meshes, RefusedFile, testing::ValuesIn(bad_meshes),
                         [](const auto& info) { return info.param.name; });

const BadFile bad_characters[] = {
    {"nan_position", "bvh", "0 0 0 0 0 0 10", "0 nan 0 0 0 0 10", ":19: frame 0 = nan: ", "expected a finite number"},
    {"surface_without_motion", "bvh", "", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ": ", "no clip: expected BVH",
     "a.obj"},
    {"joint_is_no_array", "skeleton", "", "[joint]\nname = \"a\"\n", ":1: joint: ", "[[joint]]"},
    {"missing_tail", "skeleton", "tail_m = [1, 0, 0]\n", "", ":6: tail_m: ", "missing"},
    {"name_is_a_number", "skeleton", "\"root\"", "7", ":2: name = 7: ", "expected a string"},
    {"empty_name", "skeleton", "\"root\"", "\"\"", ":1: name", "expected a name"},
    {"nearly_no_length", "skeleton", "[1, 0, 0]", "[0.5000000000001, 0, 0]", ":6: child.tail_m", "needs a length"},
    {"four_fields", "weights", "0,upper,1", "0,upper,1,1", ":2: ", "three fields"},
    {"vertex_is_text", "weights", "0,upper,1", "one,upper,1", ":2: vertex = one: ", "0 to 1"},
    {"weight_above_one", "weights", "0,upper,1", "0,upper,1.5", ":2: weight = 1.5: ", "0 <= weight <= 1"},
    {"weight_is_text", "weights", "0,upper,1", "0,upper,1x", ":2: weight = 1x: ", "0 <= weight <= 1"},
    {"collada_joint", "collada", "root elbow", "root wrist", "", ""},
    {"collada_fewer_weights", "collada", "<v>0 0 0 1 1 1 1 0 0 2 1 3", "<v>0 0 0 1 1 1 1 0 0 2", "", ""},
    {"collada_corner", "collada", "0 1 3 1 2 3", "0 1 3 1 2 9", "", ""},
    {"collada_without_the_end_of_a_mesh", "collada", "</mesh>", "", "", ""},
    // assimp would leave the weight out without a message
    {"collada_weight", "collada", "0.25 0.75", "0.25 nan", "",
     "controller skin, weight of point 3 = nan: expected a finite number of 0 or more"},
    {"fbx_weight", "fbx", "a: 0.5,1,0.75", "a: 0.5,1,-0.75", "", "0 or more"},
    {"fbx_version", "fbx", "FBXVersion: 7400", "FBXVersion: 400", ": FBXVersion = 400: ", "expected 7000 or more"},
    {"fbx_connections", "fbx", "Connections:  {", "Connections:  ", "", "expected the name of a record and a colon"},
    {"fbx_cycle", "fbx", "C: \"OO\",4,3", "C: \"OO\",4,4\nC: \"OO\",4,3",
     ": Model elbow, parent = elbow: ", "expected one parent"},
    {"fbx_cluster", "fbx", "a: 1,2,3", "a: 1,1003,3", ": Deformer 7, Indexes = 1003: ", "expected a point from 0 to 3"},
    {"fbx_array", "fbx", "Vertices: *12", "Vertices: *11", "", "states 11 numbers and has 12"},
    {"fbx_corner", "fbx", "a: 0,1,-4,1,2,-4", "a: 0,1,-5,1,2,-4",
     ": Geometry arm, PolygonVertexIndex = -5: ", "of the 4 in Vertices"},
    // on this file assimp 5.2.5 reads beyond its memory; its own process contains that
    {"collada_stride", "collada", "stride='3'", "stride='2147483647'", "", ""},
};
INSTANTIATE_TEST_SUITE_P(Characters, RefusedFile, testing::ValuesIn(bad_characters),
                         [](const auto& info) { return info.param.name; });

const std::string primitive = "/meshes/0/primitives/0/", attributes = ": meshes/0/primitives/0/attributes/",
                  of_points = attributes + "POSITION = ";
const std::string beyond = "its elements reach beyond the bytes of their buffer", sampler = "/animations/0/samplers/0/";

// The sparse accessor of the points. Its indices are the numbers of another view.
std::string sparse(const std::string& count, const std::string& indices = R"({"bufferView": 1, "componentType": 5123})")
{
    return R"({"count": )" + count + R"(, "values": {"bufferView": 0}, "indices": )" + indices + "}";
}

const BadFile bad_gltf[] = {
    {"version_1", "gltf", "/asset/version", R"("1.0")", ": asset.version = 1.0: ", "expected 2.0"},
    {"own_parent", "gltf", "/nodes/1/children", "[1]", ": nodes/1/children = 1: ", "one parent per node"},
    {"two_parents", "gltf", "/nodes/2/children", "[1]", ": nodes/2/children = 1: ", "one parent per node"},
    {"rotation_of_zero", "gltf", "/nodes/1/rotation", "[0, 0, 0, 0]", ": nodes/1/rotation: ", "not zero"},
    {"scene_out_of_range", "gltf", "/scene", "1", ": scene = 1: ", "does not exist"},
    {"node_of_scene_out_of_range", "gltf", "/scenes/0/nodes", "[7]", ": scenes/0/nodes = 7: ", "a node of the file"},
    {"node_twice_in_scene", "gltf", "/scenes/0/nodes", "[0, 1, 2, 2]", ": scenes/0/nodes = ", "each node once"},
    {"mesh_out_of_range", "gltf", "/nodes/2/mesh", "1", ": nodes/2/mesh = 1: ", "does not exist"},
    {"no_points", "gltf", primitive + "attributes/POSITION", "", attributes + "POSITION: ", "missing"},
    {"no_weights", "gltf", primitive + "attributes/WEIGHTS_0", "", attributes + "WEIGHTS_0: ", "missing"},
    {"points_as_scalars", "gltf", primitive + "attributes/POSITION", "1", of_points + "1: ", "3 numbers per element"},
    {"accessor_out_of_range", "gltf", primitive + "attributes/WEIGHTS_0", "70",
     attributes + "WEIGHTS_0 = 70: ", "an accessor of the file"},
    {"indices_out_of_range", "gltf", primitive + "indices", "70", ": no glTF that tinygltf can read: ", "indices"},
    {"fewer_weights_than_points", "gltf", "/accessors/3/count", "1",
     attributes + "WEIGHTS_0 = 1: ", "as many as there are points, 4"},
    {"fewer_joints_than_points", "gltf", "/accessors/2/count", "1",
     attributes + "JOINTS_0 = 1: ", "as many as there are points, 4"},
    {"skin_out_of_range", "gltf", "/nodes/2/skin", "1", ": skin = 1: ", "does not exist"},
    {"fewer_matrices_than_joints", "gltf", "/accessors/4/count", "1",
     ": skins/0/inverseBindMatrices = 1: ", "one per joint"},
    {"matrices_as_vectors", "gltf", "/skins/0/inverseBindMatrices", "3",
     ": skins/0/inverseBindMatrices = 3: ", "16 numbers per element"},
    {"one_point_more", "gltf", "/accessors/0/count", "5", of_points + "5: ", beyond},
    {"points_from_the_second_number_on", "gltf", "/accessors/0/byteOffset", "4", of_points + "4: ", beyond},
    {"stride_beyond_the_view", "gltf", "/bufferViews/0/byteStride", "16", of_points + "4: ", beyond},
    {"stride_below_a_point", "gltf", "/bufferViews/0/byteStride", "8", of_points + "4: ", beyond},
    {"view_that_begins_beyond_its_buffer", "gltf", "/bufferViews/0/byteOffset", "1000000", of_points + "4: ", beyond},
    {"view_that_ends_beyond_its_buffer", "gltf", "/bufferViews/0/byteLength", "1000000", of_points + "4: ", beyond},
    {"view_out_of_range", "gltf", "/accessors/0/bufferView", "70", of_points + "70: ", "a buffer view of the file"},
    {"buffer_out_of_range", "gltf", "/bufferViews/0/buffer", "1", of_points + "1: ", "a buffer of the file"},
    {"sparse_index_out_of_range", "gltf", "/accessors/0/sparse",
     sparse("1", R"({"bufferView": 3, "byteOffset": 2, "componentType": 5121})"), of_points + "128",
     "an index of the accessor's elements"},
    {"sparse_values_beyond", "gltf", "/accessors/0/sparse", sparse("5"), of_points + "5: ", beyond},
    {"sparse_count_negative", "gltf", "/accessors/0/sparse", sparse("-1"), of_points + "-1: ", "0 or more"},
    {"no_sampler", "gltf", "/animations/0/channels/0/sampler", "1",
     ": animations/0/channels/0/sampler = 1: ", "sampler of the animation"},
    {"animated_colour", "gltf", "/animations/0/channels/0/target/path", R"("colour")",
     ": animations/0/channels/0/target/path = colour: ", "expected translation, rotation, scale or weights"},
    {"interpolation", "gltf", sampler + "interpolation", R"("BEZIER")",
     ": animations/0/samplers/0/interpolation = BEZIER: ", "expected LINEAR, STEP or CUBICSPLINE"},
    {"spline_without_tangents", "gltf", sampler + "interpolation", R"("CUBICSPLINE")",
     ": animations/0/samplers/0/output = 2: ", "expected 6 for 2 keys"},
    {"rotations_as_vectors", "gltf", sampler + "output", "0",
     ": animations/0/samplers/0/output = 0: ", "4 numbers per element"},
    {"no_keys", "gltf", "/accessors/5/count", "0", ": animations/0/samplers/0/input: ", "at least one key"},
};
INSTANTIATE_TEST_SUITE_P(Gltf, RefusedFile, testing::ValuesIn(bad_gltf),
                         [](const auto& info) { return info.param.name; });

TEST(RefusedMesh, AScriptNamedAsAMeshIsNotRun)
{
    const ScratchFolder folder;
    const std::string trace = folder / "trace", script = "SystemCall \"touch " + trace + "\";\n";
    EXPECT_NE(answer_of(reader_named("gmsh"), folder.file("a.msh", script)).find("$MeshFormat"), std::string::npos);
    EXPECT_NE(answer_of(reader_named("medit"), folder.file("a.mesh", script)).find("MeshVersionFormatted"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(trace));
}

TEST(RefusedMesh, TetGensOtherHalfHasToBeAFile)
{
    const ScratchFolder folder;
    const Reader& tets = reader_named("tetgen_tets");
    const std::string path = folder.file("a.ele", sound(tets.text)), other = folder / "a.node";
    EXPECT_EQ(answer_of(tets, path), other + ": no such file");
    ASSERT_EQ(mkfifo(other.c_str(), 0600), 0);
    EXPECT_EQ(answer_of(tets, path), other + ": expected a file");
}

}  // namespace
}  // namespace readers
