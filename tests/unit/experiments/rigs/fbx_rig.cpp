// Reference: the format's formulas, computed by hand for a bone that bends or a node that moves; each kind of file by
// its name. Files hold numbers with 17 digits and are read in double precision: at most 64 roundings of numbers of at
// most 8.

#include "experiments/rigs/rig_formats.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "tests/support/fbx_file.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/weight_sums.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace {

using namespace pbs;
using test_support::FbxFile;
using test_support::FbxProperties;

const double file_rounding = test_support::rounding_error_in<double>(64, 8.0);

Rig rig_of(const FbxFile& file)
{
    const test_support::ScratchFolder folder;
    return read_fbx_rig(folder.file("arm.fbx", file.text()));
}

void expect_refused(const FbxFile& file, const std::string& field, const std::string& rule)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("arm.fbx", file.text());
    expect_input_error([&] { read_fbx_rig(path); }, path + ": " + field, rule);
}

void expect_remark(const Rig& rig, const std::string& part)
{
    EXPECT_TRUE(std::ranges::any_of(rig.remarks, [&](const std::string& remark) {
        return remark.find(part) != std::string::npos;
    })) << part;
}

std::vector<double> bound_at(const Vec3& place)
{
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -place.x(), -place.y(), -place.z(), 1};
}

// A root joint at the origin, an elbow at (0, 2, 0) and a hand at (0, 3, 0). The mesh is a tetrahedron of a point of
// the root, one that root and elbow share, one of the elbow and one of the hand.
struct ArmFile : FbxFile {
    std::int64_t root, elbow, hand, body, mesh_of_body, skin_of_mesh;

    explicit ArmFile(const FbxProperties& of_elbow = {}, const FbxProperties& of_hand = {},
                     const FbxProperties& of_body = {}, const std::string& skinning = "",
                     const test_support::FbxNumbers& points = {1, 0, 0, 0, 3, 0, 1, 3, 0, 0, 4, 1})
    {
        const auto with = [](FbxProperties properties, const FbxProperties& others) {
            properties.insert(others.begin(), others.end());
            return properties;
        };
        root = node("root", 0, "LimbNode", {});
        elbow = node("elbow", root, "LimbNode", with(of_elbow, {{"Lcl Translation", {0, 2, 0}}}));
        hand = node("hand", elbow, "LimbNode", with(of_hand, {{"Lcl Translation", {0, 1, 0}}}));
        body = node("body", 0, "Mesh", of_body);
        mesh_of_body = mesh("skin", body, points, {0, 2, -2, 0, 1, -4, 0, 3, -3, 1, 2, -4});
        skin_of_mesh = skin(mesh_of_body, skinning);
        cluster(skin_of_mesh, root, {0, 1}, {1, 0.5}, bound_at({0, 0, 0}));
        cluster(skin_of_mesh, elbow, {1, 2}, {0.5, 1}, bound_at({0, 2, 0}));
        cluster(skin_of_mesh, hand, {3}, {1}, bound_at({0, 3, 0}));
    }

    // Turns the elbow about z.
    void bend(const test_support::FbxCurveText& curve, const test_support::FbxNumbers& defaults = {0, 0, 0})
    {
        curves(layer(animation("Bend")), elbow, "Lcl Rotation", defaults, {{2, curve}});
    }
};

Positions posed_arm(const Rig& rig, double time_s)
{
    return skinned_points(rig.meshes.at(0), node_transforms(rig, find_animation(rig, ""), time_s));
}

void expect_points(const Rig& rig, double time_s, const Positions& expected)
{
    const Positions points = posed_arm(rig, time_s);
    ASSERT_EQ(points.rows(), expected.rows());
    EXPECT_LE((points - expected).cwiseAbs().maxCoeff(), file_rounding) << "at " << time_s << " s\n" << points;
}

// The points of the arm whose elbow has turned by an angle about z: about (0, 2, 0), half of the second point.
Positions bent(double degrees)
{
    const double c = std::cos(degrees * M_PI / 180.0), s = std::sin(degrees * M_PI / 180.0);
    Positions points(4, 3);
    points << 1, 0, 0, -0.5 * s, 0.5 * 3 + 0.5 * (2 + c), 0, c - s, 2 + s + c, 0, -2 * s, 2 + 2 * c, 1;
    return points;
}

TEST(FbxRig, OfAnArmMovesAsItsAnimationStates)
{
    ArmFile file;
    file.bend({{0, 1}, {0, 90}});
    file.settings["UnitScaleFactor"] = {2.54};
    const Rig rig = rig_of(file);
    EXPECT_NEAR(rig.unit_m, 0.0254, 1e-15);
    for (const double time_s : {0.0, 0.3, 1.0}) expect_points(rig, time_s, bent(90.0 * time_s));
    EXPECT_EQ(rig.animations.at(0).name, "Bend");
    EXPECT_EQ(rig.animations.at(0).end_s, 1.0);
    EXPECT_EQ(rig.meshes.at(0).triangles.rows(), 4);
    EXPECT_TRUE(rig.remarks.empty());
}

TEST(FbxRig, TurnsByMoreThanHalfARoundBetweenTwoKeys)
{
    ArmFile file;
    file.bend({{0, 1}, {0, 360}});
    for (const double time_s : {0.25, 0.5, 0.75, 1.0}) expect_points(rig_of(file), time_s, bent(360.0 * time_s));
}

TEST(FbxRig, HasSteppedAndCubicCurves)
{
    for (const auto& [flags, angle_deg] :
         {std::pair<std::int64_t, double>(2, 0.0), {2 | 0x100, 90.0}, {4, 90 * 0.25}, {8, 90 * 0.15625}}) {
        ArmFile file;  // 3 t^2 - 2 t^3 = 0.15625 at t = 0.25
        file.bend({{0, 1}, {0, 90}, flags});
        expect_points(rig_of(file), 0.25, bent(angle_deg));
    }
}

TEST(FbxRig, HasTheSlopesAndWeightsThatAreStored)
{
    ArmFile file;
    file.bend({{0, 1}, {0, 90}, 8 | 0x400, {80, -40, 0, 0}});
    const double t = 0.25, hermite = 90 * (3 * t * t - 2 * t * t * t) + 80 * (t * t * t - 2 * t * t + t) -
                                     40 * (t * t * t - t * t);
    expect_points(rig_of(file), t, bent(hermite));
    ArmFile weighted;
    const double weights = 5000 + 65536.0 * 2500;  // 0.5 and 0.25 of the time
    weighted.bend({{0, 1}, {0, 90}, 8 | 0x400 | 0x1000000 | 0x2000000, {80, -40, weights, 0}});
    const double u = 0.6, time_s = 3 * u * (1 - u) * (1 - u) * 0.5 + 3 * u * u * (1 - u) * 0.75 + u * u * u;
    expect_points(rig_of(weighted), time_s,
                  bent(3 * u * (1 - u) * (1 - u) * 40 + 3 * u * u * (1 - u) * (90 + 10) + u * u * u * 90));
}

// Where the slopes follow from the neighbours: a smooth key between two others, and Kochanek-Bartels splines without
// tension, which are Catmull and Rom's where keys have equal distances.
TEST(FbxRig, HasSlopesThatFollowFromTheNeighbours)
{
    const auto angle_at = [](std::int64_t flags, double time_s) {
        ArmFile file;
        file.bend({{0, 1, 2}, {0, 30, 90}, flags});
        const RigAnimation animation = rig_of(file).animations.at(0);
        return value_at(*animation.nodes.at(0).fbx[1][2], time_s);
    };
    const double middle = (90 - 0) / 2.0, t = 0.5;  // slope of the key between them, and the middle of a piece
    const auto hermite = [&](double a, double b, double slope_a, double slope_b) {
        return 0.5 * (a + b) + 0.125 * (slope_a - slope_b);
    };
    for (const std::int64_t flags : {8 | 0x100 | 0x2000, 8 | 0x100, 8 | 0x200}) {
        EXPECT_NEAR(angle_at(flags, t), hermite(0, 30, 30, middle), 1e-12) << flags;
        EXPECT_NEAR(angle_at(flags, 1 + t), hermite(30, 90, middle, 60), 1e-12) << flags;
    }
    // Clamped: flat at the ends, and a slope with which the tangent of a third of the time does not pass the
    // neighbours.
    EXPECT_NEAR(angle_at(8 | 0x100 | 0x2000 | 0x4000, t), hermite(0, 30, 0, middle), 1e-12);
    ArmFile peak;
    peak.bend({{0, 1, 2}, {0, 30, 0}, 8 | 0x100 | 0x4000});
    EXPECT_NEAR(value_at(*rig_of(peak).animations.at(0).nodes.at(0).fbx[1][2], t), 15.0, 1e-12);
}

TEST(FbxRig, HasTheDefaultsOfACurveNodeOnAxesWithoutACurve)
{
    ArmFile file({{"Lcl Rotation", {0, 0, 20}}});
    file.bend({{0, 1}, {0, 90}}, {180, 0, 0});  // y and z are mirrored after the turn about z, since x turns first
    const Rig rig = rig_of(file);
    const Eigen::Affine3d elbow = node_transforms(rig, &rig.animations.at(0), 1.0).at(2);
    EXPECT_LE((elbow * Vec3(1, 0, 0) - Vec3(0, 3, 0)).norm(), file_rounding);
    EXPECT_LE((elbow * Vec3(0, 1, 0) - Vec3(1, 2, 0)).norm(), file_rounding);
    const Eigen::Affine3d at_rest = node_transforms(rig, nullptr, 0.0).at(2);
    EXPECT_NEAR((at_rest * Vec3(1, 0, 0)).y(), 2.0 + std::sin(20 * M_PI / 180.0), file_rounding);
}

TEST(FbxRig, CountsTimesFromTheStartOfTheAnimation)
{
    ArmFile file;
    file.curves(file.layer(file.animation("Late", 10.0, 11.0)), file.elbow, "Lcl Rotation", {0, 0, 0},
                {{2, {{10, 11, 20}, {0, 90, 0}}}});
    const Rig rig = rig_of(file);
    EXPECT_NEAR(rig.animations.at(0).start_s, 0.0, 1e-9);
    EXPECT_NEAR(rig.animations.at(0).end_s, 1.0, 1e-9);
    expect_points(rig, 0.5, bent(45.0));
}

TEST(FbxRig, PlacesPivotsOffsetsAndRotationsOfAnAnimatedJoint)
{
    ArmFile file({{"RotationPivot", {0, 0.5, 0}},
                  {"PreRotation", {0, 0, 30}},
                  {"PostRotation", {0, 0, 10}},
                  {"RotationActive", {1}}});
    file.bend({{0, 1}, {0, 90}});
    const Rig rig = rig_of(file);
    for (const double time_s : {0.0, 0.7, 1.0}) {
        const Eigen::Affine3d elbow = node_transforms(rig, &rig.animations.at(0), time_s).at(2);
        EXPECT_LE((elbow * Vec3(0, 0.5, 0) - Vec3(0, 2.5, 0)).norm(), file_rounding) << "the pivot stays";
        const double angle = (30.0 + 90.0 * time_s - 10.0) * M_PI / 180.0;
        EXPECT_LE((elbow.linear() * Vec3(1, 0, 0) - Vec3(std::cos(angle), std::sin(angle), 0)).norm(), file_rounding);
    }
}

TEST(FbxRig, IgnoresRotationsThatAreNotActiveWithARemark)
{
    ArmFile file({{"PreRotation", {0, 0, 30}}});
    expect_points(rig_of(file), 0.0, bent(0.0));
    expect_remark(rig_of(file), "RotationOrder, PreRotation and PostRotation of node elbow are ignored");
}

TEST(FbxRig, ScalesAsTheInheritTypeStates)
{
    const auto place_of_last_point = [](const FbxProperties& of_hand) {
        return Vec3(posed_arm(rig_of(ArmFile({{"Lcl Scaling", {2, 3, 4}}}, of_hand)), 0.0).row(3));
    };  // the hand is at (0, 1, 0) of the elbow, and the point at (0, 1, 1) of the hand
    EXPECT_LE((place_of_last_point({}) - Vec3(0, 2 + 3 + 3, 4)).norm(), file_rounding);
    EXPECT_LE((place_of_last_point({{"InheritType", {1}}}) - Vec3(0, 2 + 3 + 3, 4)).norm(), file_rounding);
    EXPECT_LE((place_of_last_point({{"InheritType", {2}}}) - Vec3(0, 2 + 3 + 1, 1)).norm(), file_rounding);
    // y to z, z to -y: RrSs scales along the hand's own axes
    const FbxProperties turned = {{"Lcl Rotation", {90, 0, 0}}};
    FbxProperties own_axes = turned;
    own_axes["InheritType"] = {0};
    EXPECT_LE((place_of_last_point(turned) - Vec3(0, 2 + 3 - 3, 4)).norm(), file_rounding);
    EXPECT_LE((place_of_last_point(own_axes) - Vec3(0, 2 + 3 - 4, 3)).norm(), file_rounding);
    expect_refused(ArmFile({}, {{"InheritType", {3}}}), "Model hand, InheritType = 3", "expected 0 (RrSs)");
}

TEST(FbxRig, TakesPropertiesThatANodeDoesNotStateFromTheDefaultsOfItsType)
{
    ArmFile file({{"Lcl Scaling", {2, 3, 4}}});
    file.definitions = {
        test_support::fbx_record("ObjectType", {std::string("Model")},
                                 {test_support::fbx_record("PropertyTemplate", {std::string("FbxNode")},
                                                           {test_support::fbx_properties({{"InheritType", {2}}})})})};
    EXPECT_LE((Vec3(posed_arm(rig_of(file), 0.0).row(3)) - Vec3(0, 2 + 3 + 1, 1)).norm(), file_rounding);
}

TEST(FbxRig, MovesPointsByTheGeometricTransformBeforeTheSkin)
{
    const FbxProperties geometric = {
        {"GeometricTranslation", {0.5, 0, 0}}, {"GeometricRotation", {0, 0, 90}}, {"GeometricScaling", {2, 1, 1}}};
    const auto original = [](double x, double y, double z) { return Vec3(y / 2.0, -(x - 0.5), z); };  // its inverse
    test_support::FbxNumbers points;
    for (const auto& [x, y, z] :
         {std::tuple(1.0, 0.0, 0.0), std::tuple(0.0, 3.0, 0.0), std::tuple(1.0, 3.0, 0.0), std::tuple(0.0, 4.0, 1.0)})
        for (const double number : original(x, y, z)) points.push_back(number);
    ArmFile file({}, {}, geometric, "", points);
    file.bend({{0, 1}, {0, 90}});
    expect_points(rig_of(file), 1.0, bent(90.0));
}

// A sword on the hand, whose points are turned by the geometric transform and then by the node and its joint.
TEST(FbxRig, MovesAMeshWithoutASkinByItsNode)
{
    ArmFile file;
    file.bend({{0, 1}, {0, 90}});
    const auto sword =
        file.node("sword", file.hand, "Mesh", {{"Lcl Translation", {0, 0, 1}}, {"GeometricTranslation", {0, 2, 0}}});
    file.mesh("blade", sword, {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, -3});
    const Rig rig = rig_of(file);
    const Positions points = skinned_points(rig.meshes.at(1), node_transforms(rig, &rig.animations.at(0), 1.0));
    // (0, 5, 1) and its neighbours turned about (0, 2, 0)
    const Positions expected{{-3, 2, 1}, {-3, 3, 1}, {-4, 2, 1}};
    EXPECT_LE((points - expected).cwiseAbs().maxCoeff(), file_rounding);
}

// Points with one joint move as before; the shared one turns by half of the angle about the elbow and keeps its
// distance, 1.
TEST(FbxRig, BlendsByDualQuaternionsWhereTheSkinAsksForThem)
{
    const double share = 0.25;
    for (const std::string kind : {"", "Linear", "Rigid", "DualQuaternion", "Blend"}) {
        ArmFile file({}, {}, {}, kind);
        file.bend({{0, 1}, {0, 90}});
        auto& skin =
            *std::ranges::find_if(file.objects, [](const FbxRecord& object) { return object.record("SkinningType"); });
        skin.records.push_back(test_support::fbx_record("Indexes", {test_support::FbxNumbers{1}}));
        skin.records.push_back(test_support::fbx_record("BlendWeights", {test_support::FbxNumbers{share}}));
        const Vec3 by_quaternions(-std::sqrt(0.5), 2 + std::sqrt(0.5), 0);
        const double part = kind == "DualQuaternion" ? 1.0 : kind == "Blend" ? share : 0.0;
        Positions expected = bent(90.0);
        expected.row(1) = (1.0 - part) * expected.row(1) + part * by_quaternions.transpose();
        expect_points(rig_of(file), 1.0, expected);
        const Rig rig = rig_of(file);
        const RigAnimation* animation = find_animation(rig, "");
        const RiggedBody body = make_rigged_body(rig, animation, 1.0);
        const Positions by_pose = artist_points(body, rigid_pose(body, node_transforms(rig, animation, 1.0)));
        EXPECT_LE((by_pose - rig.unit_m * expected).cwiseAbs().maxCoeff(), file_rounding)
            << "by a pose of the skeleton";
        file.objects[0].records = {test_support::fbx_properties({{"Lcl Scaling", {2, 2, 2}}})};  // of the root
        expect_points(rig_of(file), 1.0, 2.0 * expected);
    }
    expect_refused(ArmFile({}, {}, {}, "Muscle"), "Deformer ", "SkinningType = Muscle: expected Linear");
}

TEST(FbxRig, TellsNodesOfOneNameApart)
{
    ArmFile file;
    for (FbxRecord& object : file.objects)
        if (object.name == "Model") object.values[1] = std::string("Model::Bone");
    file.bend({{0, 1}, {0, 90}});
    expect_points(rig_of(file), 1.0, bent(90.0));
}

TEST(FbxRig, LeavesAnAnimationOutThatItCannotEvaluate)
{
    ArmFile layers;
    const auto animation = layers.animation("Bend");
    for (int layer = 0; layer < 2; ++layer)
        layers.curves(layers.layer(animation), layers.elbow, "Lcl Rotation", {0, 0, 0}, {{2, {{0, 1}, {0, 90}}}});
    EXPECT_TRUE(rig_of(layers).animations.empty());
    expect_remark(rig_of(layers), "animation Bend is left out: two of its layers move Lcl Rotation of elbow; bake it");
    ArmFile pivot;
    pivot.curves(pivot.layer(pivot.animation("Bend")), pivot.elbow, "RotationPivot", {0, 0, 0},
                 {{2, {{0, 1}, {0, 90}}}});
    expect_remark(rig_of(pivot), "animation Bend is left out: it moves RotationPivot of elbow");
    ArmFile added({{"Lcl Rotation", {0, 0, 5}}});
    const auto adding = added.animation("Bend");
    added.layer(adding);
    added.curves(added.layer(adding), added.elbow, "Lcl Rotation", {0, 0, 0}, {{2, {{0, 1}, {0, 90}}}});
    expect_remark(rig_of(added), "animation Bend is left out: its layer Layer adds to Lcl Rotation of elbow");
    ArmFile muted;
    const auto one_muted = muted.animation("Bend");
    muted.curves(muted.layer(one_muted, {{"Mute", {1}}}), muted.elbow, "Lcl Rotation", {0, 0, 0},
                 {{2, {{0, 1}, {0, 10}}}});
    muted.curves(muted.layer(one_muted), muted.elbow, "Lcl Rotation", {0, 0, 0}, {{2, {{0, 1}, {0, 90}}}});
    expect_points(rig_of(muted), 1.0, bent(90.0));
}

TEST(FbxRig, LeavesAnAnimationOutWhoseCurveGoesOnBeyondItsKeys)
{
    for (const auto& [kind, stop_s, is_left_out] : {std::tuple("R", 4.0, true), {"R", 1.0, false}, {"C", 4.0, false}}) {
        ArmFile file;
        file.curves(file.layer(file.animation("Bend", 0.0, stop_s)), file.elbow, "Lcl Rotation", {0, 0, 0},
                    {{2, {{0, 1}, {0, 90}}}});
        file.objects.back().records.push_back(test_support::fbx_record(
            "Post-Extrapolation", {}, {test_support::fbx_record("Type", {std::string(kind)})}));
        EXPECT_EQ(rig_of(file).animations.empty(), is_left_out) << kind << stop_s;
    }
}

TEST(FbxRig, NamesWhatIsWrong)
{
    expect_refused(ArmFile({{"RotationOrder", {6}}, {"RotationActive", {1}}}), "Model elbow, RotationOrder = 6",
                   "export glTF 2.0");
    ArmFile beyond;
    beyond.cluster(beyond.skin_of_mesh, beyond.hand, {4}, {1}, bound_at({0, 0, 0}));
    expect_refused(beyond, "Deformer ", "Indexes = 4: expected a point from 0 to 3");
    ArmFile flat;
    flat.cluster(flat.skin_of_mesh, flat.hand, {3}, {1}, std::vector<double>(16, 0.0));
    expect_refused(flat, "Deformer ", "Transform: expected a matrix of finite numbers that has an inverse");
    ArmFile shorter;
    shorter.cluster(shorter.skin_of_mesh, shorter.hand, {3, 2}, {1}, bound_at({0, 0, 0}));
    expect_refused(shorter, "Deformer ", "Weights = 1 numbers: expected one for each of the 2");
    ArmFile back;
    back.bend({{1, 0}, {0, 90}});
    expect_refused(back, "AnimationCurve ", "key 1 = 90: expected finite numbers, and times that do not go back");
    ArmFile twice;
    twice.objects[1].values[0] = twice.root;
    expect_refused(twice, "Model = 1", "expected numbers of objects that are unique");
    ArmFile below_itself;
    below_itself.connect(below_itself.root, below_itself.hand);
    expect_refused(below_itself, "Model root, parent = hand", "expected one parent");
    ArmFile corner;
    corner.mesh("more", corner.body, {0, 0, 0}, {0, 1, -2});
    expect_refused(corner, "Geometry more, PolygonVertexIndex = 1", "expected a point of the 1");
}

// The area of a polygon in the plane is the sum of its triangles, whatever its shape, if none lies outside and none
// twice.
TEST(FbxRig, SplitsPolygonsIntoTrianglesOfTheSameArea)
{
    const test_support::FbxNumbers arrow = {0, 0, 0, 4, -3, 0, 1, 0, 0, 4, 3, 0},  // the third corner is concave
        comb = {0, 0, 0, 6, 0, 0, 6, 4, 0, 5, 1, 0, 4, 4, 0, 3, 1, 0, 2, 4, 0, 1, 1, 0, 0, 4, 0},
                                   square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    for (const auto& points : {arrow, comb, square}) {
        FbxFile file;
        const auto node = file.node("sheet", 0, "Mesh", {});
        const auto count = static_cast<int>(points.size() / 3);
        test_support::FbxNumbers corners;
        double twice_area = 0.0;
        for (int c = 0; c < count; ++c) {
            corners.push_back(c + 1 < count ? c : -c - 1);
            const int next = (c + 1) % count;
            twice_area += points[3 * c] * points[3 * next + 1] - points[3 * next] * points[3 * c + 1];
        }
        file.mesh("sheet", node, points, corners);
        const RigMesh mesh = rig_of(file).meshes.at(0);
        ASSERT_EQ(mesh.triangles.rows(), count - 2);
        double sum = 0.0;
        for (const auto& t : mesh.triangles.rowwise()) {
            const Vec3 a = mesh.points.row(t(0)), b = mesh.points.row(t(1)), c = mesh.points.row(t(2));
            const double area = (b - a).cross(c - a).z();
            EXPECT_GT(area, 0.0) << "no triangle is turned over";
            sum += area;
        }
        EXPECT_NEAR(sum, twice_area, 1e-12);
    }
}

TEST(FbxRig, SplitsPointsWhereTheirNormalsDifferAndDropsUnusedOnes)
{
    FbxFile file;
    const auto node = file.node("roof", 0, "Mesh", {});
    // point 1 is in no triangle
    file.mesh("roof", node, {0, 0, 0, 9, 9, 9, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 2, -4, 0, 3, -5});
    const auto layer = [](const test_support::FbxNumbers& normals) {
        return test_support::fbx_record(
            "LayerElementNormal", {std::int64_t(0)},
            {test_support::fbx_record("MappingInformationType", {std::string("ByPolygonVertex")}),
             test_support::fbx_record("Normals", {normals})});
    };
    auto& geometry = file.objects.back();
    geometry.records.push_back(layer({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
    EXPECT_EQ(rig_of(file).meshes.at(0).points.rows(), 4);
    geometry.records.back() = layer({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0, 1, 0});
    const RigMesh split = rig_of(file).meshes.at(0);
    EXPECT_EQ(split.points.rows(), 6) << "two points have two normals";
    for (Eigen::Index f = 0; f < 2; ++f)
        for (int c = 0; c < 3; ++c) EXPECT_EQ(split.look.numbers(split.triangles(f, c), f == 0 ? 2 : 1), 1.0F);
}

TEST(FbxRig, NamesMorphTargetsAndShapesThatAreNoPolygons)
{
    ArmFile file;
    const auto shapes = file.add("Deformer", "", "BlendShape", file.mesh_of_body, {});
    const auto channel = file.add("Deformer", "", "BlendShapeChannel", shapes, {});
    file.add("Geometry", "smile", "Shape", channel, {});
    file.add("Geometry", "sleeve", "NurbsSurface", file.body, {});
    expect_remark(rig_of(file), "mesh skin: 1 morph targets are left out");
    expect_remark(rig_of(file),
                  "geometry sleeve of node body is left out: it is a NurbsSurface; convert it into a polygon mesh");
}

TEST(FbxRig, OfABinaryFileHasBonesWithWeights)
{
    const std::string path = "/usr/share/assimp/models/FBX/animation_with_skeleton.fbx";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "assimp-testmodels is not installed";
    const Rig rig = read_rig(path);
    ASSERT_FALSE(rig.meshes.empty());
    for (const RigMesh& mesh : rig.meshes)
        for (int p = 0; p < mesh.skin.vertices(); ++p)
            EXPECT_NEAR(test_support::sum_of_weights(mesh.skin, p), 1.0, 1e-12) << "point " << p << " of " << mesh.name;
    EXPECT_TRUE(
        std::any_of(rig.meshes.begin(), rig.meshes.end(), [](const RigMesh& mesh) { return mesh.joints.size() > 1; }));
}

}  // namespace
