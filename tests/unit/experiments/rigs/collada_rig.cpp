// Reference: an arm of two joints whose skinned points are computed by hand, as COLLADA, and as FBX with the same
// content. assimp computes in single precision: at most 64 roundings of numbers of at most 8 of the files' units.

#include "experiments/rigs/rig_formats.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <vector>

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
    return read_rig(folder.file(name, text));
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
        EXPECT_LE((posed.row(found) - 0.01 * expected_cm.row(p)).norm(), assimp_rounding_m)
            << "at " << time_s << " s, point " << p;
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

TEST(ColladaRig, AnArmAsColladaAndFbx)
{
    const Rig collada = rig_in("arm.dae", test_support::collada_arm());
    expect_bent_arm(collada);
    EXPECT_FALSE(collada.nodes[std::size_t(node_named(collada, "elbow"))].rest.matrix)
        << "an animation replaces the matrix of its node";
    EXPECT_TRUE(collada.nodes[std::size_t(node_named(collada, "root"))].rest.matrix);
    expect_bent_arm(rig_in("arm.dae", test_support::collada_arm(2)));  // the bind shape matrix moves the points first
    const Rig rig = rig_in("arm.fbx", test_support::fbx_arm());
    EXPECT_EQ(rig.unit_m, 0.01);
    expect_bent_arm(rig);
    std::string text = test_support::fbx_arm();
    const std::string stated = "\"Number\", \"\",1\n}";
    text.replace(text.find(stated), stated.size(), "\"Number\", \"\",2.54\n}");
    EXPECT_NEAR(rig_in("arm.fbx", text).unit_m, 0.0254, 1e-9);
}

// Reference: the format's rules for what assimp drops or applies otherwise, on the same arm.

std::string replaced(std::string text, const std::string& part, const std::string& other)
{
    EXPECT_NE(text.find(part), std::string::npos) << part;
    return text.replace(text.find(part), part.size(), other);
}

std::string arm_with(const std::string& part, const std::string& other)
{
    return replaced(test_support::collada_arm(), part, other);
}

// The place [cm] of the point that is at (1, 4, 0) at rest and follows the elbow, and the angle by which it has turned.
double elbow_deg(const Rig& rig, double time_s)
{
    const Positions bound = skinned_points(rig.meshes.at(0), node_transforms(rig, nullptr, 0.0)),
                    posed = skinned_points(rig.meshes.at(0), node_transforms(rig, find_animation(rig, ""), time_s));
    Eigen::Index tip = 0;
    bound.col(1).maxCoeff(&tip);
    const Vec3 arm = rig.unit_m * 100.0 * Vec3(posed.row(tip)) - Vec3(1, 2, 0);
    return std::atan2(-arm.x(), arm.y()) * 180.0 / M_PI;
}

constexpr double angle_rounding_deg =
    1e-3;  // single precision of numbers with a magnitude of 90, and 1e-6 of their range

TEST(ColladaRig, HasSteppedCurves)
{
    const Rig rig = rig_in("arm.dae", arm_with("LINEAR LINEAR", "STEP STEP"));
    for (const double time_s : {0.0, 0.5, 0.999}) EXPECT_NEAR(elbow_deg(rig, time_s), 0.0, angle_rounding_deg);
    EXPECT_NEAR(elbow_deg(rig, 1.0), 90.0, angle_rounding_deg);
}

std::string tangents(const std::string& id, const std::string& numbers)
{
    return "<source id='" + id + "'><float_array id='" + id + "-array' count='4'>" + numbers +
           "</float_array><technique_common><accessor source='#" + id +
           "-array' count='2' stride='2'><param name='X' type='float'/><param name='Y' "
           "type='float'/></accessor></technique_common></source>";
}

TEST(ColladaRig, HasBezierCurves)
{
    std::string text = arm_with("LINEAR LINEAR", "BEZIER BEZIER");
    text = replaced(text, "<sampler id",
                    tangents("in", "-0.2 0 0.6 70") + tangents("out", "0.8 -10 1.3 90") + "<sampler id");
    text = replaced(text, "<input semantic=\"INTERPOLATION\"",
                    "<input semantic=\"IN_TANGENT\" source=\"#in\"/><input semantic=\"OUT_TANGENT\" source=\"#out\"/>"
                    "<input semantic=\"INTERPOLATION\"");
    const Rig rig = rig_in("arm.dae", text);
    for (double t = 0.0; t <= 1.0; t += 0.125) {
        const double u = 1.0 - t, time_s = 3 * u * u * t * 0.8 + 3 * u * t * t * 0.6 + t * t * t;
        EXPECT_NEAR(elbow_deg(rig, time_s), 3 * u * u * t * -10 + 3 * u * t * t * 70 + t * t * t * 90,
                    angle_rounding_deg)
            << t;
    }
}

// Two angles from 0 to 90 degrees: at half of the time the forearm turns by 45 degrees about x and then about z,
// whereas the shortest way from the first key to the second one turns about the axis (1, 1, 1).
TEST(ColladaRig, InterpolatesEachAngle)
{
    std::string text = arm_with("<rotate sid=\"turn\">0 0 1 0</rotate>",
                                "<rotate sid=\"turn\">0 0 1 0</rotate><rotate sid=\"lift\">1 0 0 0</rotate>");
    text = replaced(text, "</animation>",
                    "<sampler id=\"second\"><input semantic=\"INPUT\" source=\"#times\"/><input semantic=\"OUTPUT\" "
                    "source=\"#angles\"/>"
                    "<input semantic=\"INTERPOLATION\" source=\"#kinds\"/></sampler><channel source=\"#second\" "
                    "target=\"elbow/lift.ANGLE\"/></animation>");
    const Rig rig = rig_in("arm.dae", text);
    const Eigen::Matrix3d elbow =
        node_transforms(rig, find_animation(rig, ""), 0.5)[std::size_t(node_named(rig, "elbow"))].linear();
    const double h = 0.5, s = std::sqrt(0.5);
    const Eigen::Matrix3d expected = (Eigen::Matrix3d() << s, -h, h, s, h, -h, 0, s, s).finished();
    EXPECT_LE((elbow / std::cbrt(elbow.determinant()) - expected).cwiseAbs().maxCoeff(), 3e-5)
        << "half a degree, squared, over 8, twice";
}

void expect_collada_refused(const std::string& text, const std::string& field, const std::string& rule)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("arm.dae", text);
    expect_input_error([&] { read_rig(path); }, path + ": " + field, rule);
}

TEST(ColladaRig, RefusesCurvesOfOtherKindsByName)
{
    expect_collada_refused(arm_with("LINEAR LINEAR", "HERMITE HERMITE"), "animation bend, INTERPOLATION = HERMITE",
                           "export glTF 2.0");
    expect_collada_refused(arm_with("LINEAR LINEAR", "STEP"), "animation bend, INTERPOLATION = 1",
                           "expected as many times");
    expect_collada_refused(arm_with("LINEAR LINEAR", "BEZIER BEZIER"), "animation bend, IN_TANGENT",
                           "expected a time and a value");
}

TEST(ColladaRig, KeepsPointsOfTheBindShapeInPlace)
{
    std::string text = arm_with("<v>0 0 0 1", "<v>-1 0 0 1");   // the point at (1, 0, 0)
    text = replaced(text, "elbow/turn.ANGLE", "root/place.Y");  // from 0 to 90 within 1 s
    const Rig rig = rig_in("arm.dae", text);
    const Positions posed =
        100.0 * rig.unit_m * skinned_points(rig.meshes.at(0), node_transforms(rig, find_animation(rig, ""), 1.0));
    int in_place = 0, lifted = 0;
    for (const auto& point : posed.rowwise()) {
        in_place += (point - Eigen::RowVector3d(1, 0, 0)).norm() < 1e-4;
        lifted += point.y() > 90.0;
    }
    EXPECT_EQ(in_place, 1);
    EXPECT_EQ(lifted, 3);
    EXPECT_EQ(rig.remarks,
              std::vector<std::string>{
                  "1 weights of controller skin are those of joint -1, the bind shape, which no animation moves"});
}

TEST(ColladaRig, SkinsTheBaseOfAMorph)
{
    std::string text = arm_with("<skin source=\"#arm\">", "<skin source=\"#morph\">");
    text = replaced(text, "<library_controllers>",
                    "<library_controllers><controller id=\"morph\"><morph source=\"#arm\"/></controller>");
    const Rig rig = rig_in("arm.dae", text);
    expect_bent_arm(rig);
    EXPECT_EQ(rig.remarks, std::vector<std::string>{"the morph targets of controller morph are left out"});
}

TEST(ColladaRig, FindsASkeletonInLibraryNodes)
{
    const std::string whole = test_support::collada_arm();
    const std::size_t begin = whole.find("<node id=\"root\""), end = whole.find("<node id=\"body\"");
    const std::string skeleton = whole.substr(begin, end - begin);
    std::string text = replaced(whole, skeleton, "<node id=\"rig\" name=\"rig\"><instance_node url=\"#root\"/></node>");
    text = replaced(text, "<library_visual_scenes>",
                    "<library_nodes>" + skeleton + "</library_nodes><library_visual_scenes>");
    expect_bent_arm(rig_in("arm.dae", text));
}

// The second skeleton is the first one, moved by (0, 0, 5), and no animation moves it.
TEST(ColladaRig, MovesOneSkinByTwoSkeletons)
{
    const std::string whole = test_support::collada_arm();
    const std::size_t begin = whole.find("<node id=\"root\""), end = whole.find("<node id=\"body\"");
    std::string second = replaced(whole.substr(begin, end - begin), "id=\"root\"", "id=\"other root\"");
    second = replaced(replaced(second, "id=\"elbow\"", "id=\"other elbow\""), ">1 0 0<", ">1 0 5<");
    const std::string instance =
        "<node id=\"other\"><instance_controller url=\"#skin\"><skeleton>#other "
        "root</skeleton></instance_controller></node>";
    const Rig rig = rig_in("arm.dae", replaced(whole, "</visual_scene>", second + instance + "</visual_scene>"));
    ASSERT_EQ(rig.meshes.size(), 2u);
    const auto nodes = node_transforms(rig, find_animation(rig, ""), 1.0);
    std::vector<double> tips;  // in x and z
    for (const RigMesh& mesh : rig.meshes) {
        const Positions posed = 100.0 * rig.unit_m * skinned_points(mesh, nodes);
        EXPECT_LE(posed.col(2).maxCoeff() - posed.col(2).minCoeff(), 1e-5);
        tips.push_back(posed.col(2).mean());
        EXPECT_NEAR(posed.col(1).maxCoeff(), posed(0, 2) > 2.5 ? 4.0 : 2.75, 1e-5) << "at rest, or bent by 90 degrees";
    }
    std::ranges::sort(tips);
    EXPECT_NEAR(tips[0], 0.0, 1e-5);
    EXPECT_NEAR(tips[1], 5.0, 1e-5);
    std::string by_ids = replaced(replaced(whole, "<Name_array id='joints-array'", "<IDREF_array id='joints-array'"),
                                  "root elbow</Name_array>", "root elbow</IDREF_array>");
    expect_collada_refused(replaced(by_ids, "</visual_scene>", second + instance + "</visual_scene>"),
                           "controller skin-2, joints = joints", "copy the controller");
}

}  // namespace
