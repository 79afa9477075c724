// A small package in MakeHuman's formats, complete and damaged: errors are refused with file and field. Reference: the
// formats (three.js JSON 3.1, the rig's vertex lists, int16 targets), laid out by hand.
#include "experiments/characters/named_bodies.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace {

using MakehumanFigure = test_support::FolderTest;
using namespace pbs;
using nlohmann::json;

// Every joint that the fold needs lies at a vertex of its own: vertices 4, 5, ...; the body is the tetrahedron 0 to 3,
// in decimetres.
const std::vector<std::string> joints = {
    "root____head",         "spine04____head",      "spine02____head",    "neck01____head",
    "head____head",         "head____tail",         "clavicle.*____head", "upperarm01.*____head",
    "lowerarm01.*____head", "lowerarm02.*____head", "wrist.*____head",    "finger3-3.*____tail",
    "upperleg01.*____head", "lowerleg01.*____head", "foot.*____head",     "toe2-1.*____head"};

struct Package {
    json model, rig, list;
    std::string targets;

    Package()
    {
        std::vector<double> vertices = {0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10};
        int next = 4;
        for (const std::string& joint : joints)
            for (const char side : joint.find('*') == std::string::npos ? std::string("-") : std::string("LR")) {
                std::string name = joint;
                if (side != '-') name[name.find('*')] = side;
                rig["joints"][name] = {next};
                vertices.insert(vertices.end(), {0.1 * next, 0.3 * next, side == 'L' ? 1.0 : -1.0});
                ++next;
            }
        model = {{"vertices", vertices},
                 {"materials", {{{"DbgName", "helper"}}, {{"DbgName", "body"}}}},
                 {"faces", {2, 0, 2, 1, 1, 2, 4, 5, 6, 0, 10, 0, 1, 3, 1, 0, 0, 0, 2, 0, 3, 2, 1, 2, 1, 2, 3, 1}}};
        list["targets"] = {{"data/a/asian-young.target", json::array()},
                           {"data/a/caucasian-young.target", json::array()}};
        targets.assign(2 * 2 * vertices.size(), '\0');
        targets[2 * vertices.size()] = static_cast<char>(0xe8);  // row 1, x of vertex 0: 1000 steps of 1e-3 dm
        targets[2 * vertices.size() + 1] = 3;
    }

    pbs::MakehumanFigure read(const test_support::ScratchFolder& folder, const std::vector<std::string>& with) const
    {
        return read_makehuman({folder.file("model.json", model.dump()), folder.file("rig.json", rig.dump()),
                               folder.file("list.json", list.dump()), folder.file("targets.bin", targets)},
                              with);
    }
};
TEST_F(MakehumanFigure, ReadsTheBodyAloneInMetres)
{
    const pbs::MakehumanFigure figure = Package().read(folder, {});
    EXPECT_EQ(figure.skin.points.rows(), 4);
    EXPECT_EQ(figure.skin.triangles.rows(), 4);
    EXPECT_DOUBLE_EQ(figure.skin.points(1, 0), 1.0);
    EXPECT_EQ(figure.skeleton.bones.size(), 23u);
    // A coordinate of at most 0.12 m goes through a product here, a mean, and a product by the metres per unit; both
    // factors and the number expected are rounded as well.
    EXPECT_LE((figure.skeleton.bones[0].head - Vec3(0.04, 0.12, -0.1)).norm(),
              std::sqrt(3.0) * test_support::rounding_error(6, 0.12));
    EXPECT_EQ(figure.inputs.size(), 3u);
}

TEST_F(MakehumanFigure, TargetsAreMatchedWholeAndMoveVertices)
{
    EXPECT_DOUBLE_EQ(Package().read(folder, {"caucasian-young"}).skin.points(0, 0), 0.1);
    EXPECT_EQ(Package().read(folder, {"asian-young"}).skin.points(0, 0), 0.0);
    EXPECT_EQ(Package().read(folder, {"caucasian-young"}).inputs.size(), 4u);
}

TEST_F(MakehumanFigure, RefusesTargetsThatDoNotFit)
{
    expect_input_error([&] { Package().read(folder, {"young"}); }, folder / "list.json", "0 are named young");
    Package cut;
    cut.targets.pop_back();
    expect_input_error([&] { cut.read(folder, {}); }, folder / "targets.bin", "2 targets of");
    Package unnamed;
    unnamed.list["targets"] = json::array({1});
    expect_input_error([&] { unnamed.read(folder, {}); }, folder / "list.json", "targets");
}

TEST_F(MakehumanFigure, RefusesADamagedModel)
{
    const auto refused = [&](const std::function<void(json&)>& damage, const std::string& field) {
        Package package;
        damage(package.model);
        expect_input_error([&] { package.read(folder, {}); }, folder / "model.json", field);
    };
    refused([](json& model) { model.erase("vertices"); }, "vertices: missing");
    refused([](json& model) { model["vertices"].push_back(1.0); }, "vertices");
    refused([](json& model) { model["vertices"][5] = "one"; }, "vertices[5]");
    refused([](json& model) { model["faces"].erase(model["faces"].size() - 1); }, "ends within a face");
    refused([](json& model) { model["faces"][1] = 9999; }, "faces[1]");
    refused([](json& model) { model["faces"][1] = 0.5; }, "faces[1]");
    refused([](json& model) { model["faces"][0] = 256; }, "expected a type");
    refused([](json& model) { model["materials"][1]["DbgName"] = "skin"; }, "none is named body");
    refused([](json& model) { model["faces"] = json::array(); }, "none is of the material");
}

TEST_F(MakehumanFigure, RefusesADamagedRig)
{
    const auto refused = [&](const json& joint, const std::string& field) {
        Package package;
        package.rig["joints"]["wrist.L____head"] = joint;
        expect_input_error([&] { package.read(folder, {}); }, folder / "rig.json", field);
    };
    refused(json::array(), "joints.wrist.L____head: expected vertices");
    refused({9999}, "joints.wrist.L____head");
    refused({-1}, "joints.wrist.L____head");
    refused("all", "expected an array of numbers");
    Package without;
    without.rig["joints"].erase("wrist.L____head");
    expect_input_error([&] { without.read(folder, {}); }, folder / "rig.json", "wrist.L____head: missing");
}

TEST_F(MakehumanFigure, EveryTruncationOfTheModelIsRefusedWithItsPlace)
{
    Package().read(folder, {});
    const std::string whole = Package().model.dump();
    for (std::size_t bytes = 0; bytes < whole.size(); bytes += 37) {
        const MakehumanFiles files{folder.file("cut.json", whole.substr(0, bytes)), folder / "rig.json",
                                   folder / "list.json", folder / "targets.bin"};
        expect_input_error([&] { read_makehuman(files, {}); }, folder / "cut.json:1", "cut short");
    }
}

}  // namespace
