// Reference: theory of the blends on the built-in limb, whose vertices near the joint are blended with equal weights by
// Eq. 2. For a twist by t, LBS reduces their distance from the axis by cos(t/2), so the area of the section falls by
// cos^2(t/2). This is exact where the plane cuts only triangles of such vertices. Tolerances: the rounding of the
// points at which planes cut edges.

#include "analysis/metrics/cross_section.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/meshes/meshing.hpp"
#include "experiments/studies/artefacts/artefact_case.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/blend.hpp"
#include "tests/support/mesher_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

using experiments::JointSections;

class JointSectionsOfLimb : public testing::Test {
protected:
    pbs::Positions lbs(const pbs::Vec3& axis, double angle_deg)
    {
        pose = pbs::joint_sweep(limb.skeleton, 1, axis, angle_deg, 2, 0.01).steps[1];
        pbs::Positions posed;
        pbs::linear_blend_skinning(limb.mesh.rest, limb.weights, pose, posed);
        return posed;
    }

    // The rounding error of an area or a radius over that at rest. A vertex has the rounding error of its motions, and
    // its height above a plane that of eight more roundings; a cut moves by as much over the sine of the angle between
    // its edge and the plane, and goes through six roundings. Moving all points of an outline by e changes its area by
    // at most e times its length, and a radius by 2 e; at rest, an outline has a length of 2 pi r at most, four fifths
    // of the area pi r^2 at least, and radii of 0.8 r at least. A ratio has the errors of two sections. The planes cut
    // across x.
    double rounding(const pbs::Positions& posed, int motions, double farthest_m) const
    {
        const pbs::Edges edges = pbs::edges_of(limb.mesh.tets);
        double smallest_sine = 1.0;
        for (const auto& section : sections.measure(limb.mesh.rest, pbs::Pose(2, Eigen::Isometry3d::Identity())))
            for (const auto& edge : edges.rowwise()) {
                const Eigen::RowVector3d a = posed.row(edge(0)), b = posed.row(edge(1));
                if ((a.x() - section.offset_m) * (b.x() - section.offset_m) > 0.0) continue;
                smallest_sine = std::min(smallest_sine, std::abs(a.x() - b.x()) / (a - b).norm());
            }
        const double of_vertex =
            test_support::motion_error(motions, farthest_m) + test_support::rounding_error(8, farthest_m);
        const double of_cut = of_vertex / smallest_sine + test_support::rounding_error(6, farthest_m);
        return 2.0 * 2.0 * of_cut / (0.8 * 0.15);
    }

    pbs::Character limb = pbs::make_character({.body = "limb"});
    JointSections sections{limb, experiments::limb_joints(limb)[0]};
    pbs::Pose pose;
};

TEST_F(JointSectionsOfLimb, AreWholeAtRestAndHaveNoSizeWhereTheSkinIsGone)
{
    const pbs::Pose still(2, Eigen::Isometry3d::Identity());
    const pbs::Positions away = limb.mesh.rest.rowwise() + Eigen::RowVector3d(10.0, 0.0, 0.0);
    for (const auto& section : sections.measure(away, still)) EXPECT_EQ(section.area, 0.0);
    const auto profile = sections.measure(limb.mesh.rest, still);
    const double whole = rounding(limb.mesh.rest, 0, 1.15);
    ASSERT_EQ(profile.size(), 21u);
    for (const auto& section : profile) {
        EXPECT_NEAR(section.area, 1.0, whole);
        EXPECT_NEAR(section.smallest_radius, 1.0, whole);
        EXPECT_EQ(section.outlines, 1);
        EXPECT_EQ(section.limb_share, 1.0);  // both bones are children of the parent
    }
}

TEST_F(JointSectionsOfLimb, AreaOfTheCandyWrapperIsTheSquaredCosineOfHalfTheTwist)
{
    for (const double angle_deg : {30.0, 90.0, 150.0, 180.0}) {  // half a turn leaves nothing
        const double half = 0.5 * angle_deg * std::numbers::pi / 180.0;
        const pbs::Positions twisted = lbs(pbs::Vec3::UnitX(), angle_deg);
        const auto profile = sections.measure(twisted, pose);
        const double smallest_area = std::ranges::min(profile, {}, &experiments::JointSection::area).area;
        EXPECT_NEAR(smallest_area, std::cos(half) * std::cos(half), rounding(twisted, 2, 1.15)) << angle_deg;
        EXPECT_LE(extremes_of(profile).smallest_radius, std::cos(half) + rounding(twisted, 2, 1.15)) << angle_deg;
    }
}

TEST_F(JointSectionsOfLimb, MoveWithTheWholeBody)
{
    pbs::Positions twisted = lbs(pbs::Vec3::UnitX(), 60.0);
    const auto before = sections.measure(twisted, pose);
    const double tolerance = rounding(twisted, 3, 1.15 + pbs::Vec3(3, -2, 1).norm());
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.rotate(Eigen::AngleAxisd(0.8, pbs::Vec3(1, 2, -1).normalized()));
    moved.pretranslate(pbs::Vec3(3, -2, 1));
    for (auto& bone : pose) bone = moved * bone;
    for (Eigen::Index v = 0; v < twisted.rows(); ++v) twisted.row(v) = moved * pbs::Vec3(twisted.row(v));
    const auto after = sections.measure(twisted, pose);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i].area, before[i].area, tolerance) << i;
}

TEST_F(JointSectionsOfLimb, BendIsTheAngleBetweenTheBonesAndTwistIsNone)
{
    // An angle in radians is in error by less than the matrix of a rotation.
    const double rounding_deg = 180.0 / std::numbers::pi * test_support::motion_matrix_error(2, 0.0);
    lbs(pbs::Vec3::UnitZ(), 70.0);
    EXPECT_NEAR(sections.bend_deg(pose), 70.0, rounding_deg);
    lbs(pbs::Vec3::UnitX(), 70.0);
    EXPECT_NEAR(sections.bend_deg(pose), 0.0, rounding_deg);
}

// Reference: the built-in limb's skeleton, (-1,0,0) -> 0 -> (1,0,0), and a bent one drawn by hand; for joints by hand,
// the limb with Frankie's names and, where he is installed, his skin. The limb's bones lie along an axis and are a
// metre long, so that nothing of them is rounded; nor is a vector along an axis when it is divided by its length.

using pbs::Vec3;
using test_support::on_skin_m;

TEST(LimbJoints, LimbHasOneInItsMiddleThatIsNearAThirdOfEachBone)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 600});
    const auto joints = experiments::limb_joints(limb);
    ASSERT_EQ(joints.size(), 1u);
    EXPECT_EQ(joints[0].name, "upper|forearm");
    EXPECT_EQ(joints[0].point, Vec3(Vec3::Zero()));
    EXPECT_EQ(joints[0].reach_parent_m, 0.5);
    // the vertices of the caps have the same distance from the bones' ends
    EXPECT_NEAR(joints[0].radius_m, 0.15, on_skin_m);
    EXPECT_EQ(experiments::twist_axis(limb.skeleton, joints[0]), Vec3(Vec3::UnitX()));
    EXPECT_EQ(experiments::hinge_axis(limb.skeleton, joints[0]), Vec3(Vec3::UnitZ()));
    const auto near = experiments::near_joint(limb, joints[0]);
    for (Eigen::Index v = 0; v < limb.mesh.rest.rows(); ++v)
        EXPECT_EQ(near[v], std::abs(limb.mesh.rest(v, 0)) <= 1.0 / 3.0) << limb.mesh.rest.row(v);
}

TEST(LimbJoints, HingeBendsOnTheWayThatTheJointIsBentAndIsAcrossAStraightLimb)
{
    const auto hinge = [](const Vec3& head, const Vec3& tail) {
        const pbs::Skeleton skeleton{{{"upper", -1, head, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, tail}}};
        return experiments::hinge_axis(skeleton, {"upper|forearm", 0, 1, Vec3::Zero(), 0.1, 0.5, 0.5});
    };
    EXPECT_EQ(hinge({-1, 0, 0}, {1, 0.2, 0}), Vec3(Vec3::UnitZ()));
    EXPECT_EQ(hinge({-1, 0, 0}, {1, -0.2, 0}), Vec3(-Vec3::UnitZ()));
    const Vec3 along_z = hinge({0, 0, -1}, {0, 0, 1});
    EXPECT_EQ(along_z.norm(), 1.0);
    EXPECT_EQ(along_z.z(), 0.0);
}

pbs::Character limb_as_frankie(const std::string& parent, const std::string& child)
{
    pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 600});
    limb.name = "frankie";
    limb.skeleton.bones[0].name = parent;
    limb.skeleton.bones[1].name = child;
    return limb;
}

// A polygon inscribed in a circle of radius r has at least four fifths of its area here, and no more than all of it.
TEST(JointsByHand, HaveTheirOwnReachAndTheRadiusOfTheirSection)
{
    const auto joints = experiments::limb_joints(limb_as_frankie("upper_arm.L", "forearm_upper.L"));
    ASSERT_EQ(joints.size(), 1u);
    EXPECT_EQ(joints[0].name, "upper_arm.L|forearm_upper.L");
    EXPECT_EQ(joints[0].parent, 0);
    EXPECT_EQ(joints[0].child, 1);
    EXPECT_EQ(joints[0].point, Vec3(Vec3::Zero()));
    EXPECT_GT(joints[0].radius_m, std::sqrt(0.8) * 0.15);
    EXPECT_LT(joints[0].radius_m, 0.15 + on_skin_m);
    EXPECT_EQ(joints[0].reach_parent_m, 0.25);
    EXPECT_EQ(joints[0].reach_child_m, 0.5);
}

TEST(JointsByHand, OneWithoutSectionBonesOrFleshIsLeftOutWithItsReasonAndOtherBodiesHaveNone)
{
    EXPECT_TRUE(experiments::limb_joints(limb_as_frankie("thigh.L", "shin.L")).empty());
    EXPECT_TRUE(experiments::limb_joints(limb_as_frankie("upper", "forearm")).empty());
    pbs::Character limb = limb_as_frankie("tail_1", "tail_2");
    EXPECT_EQ(experiments::limb_joints(limb).size(), 1u);
    const auto why = [&](const std::string& child) {
        for (const auto& joint : experiments::joints_by_hand("frankie"))
            if (joint.child == child) return experiments::why_left_out(limb, joint);
        return std::string("not_named");
    };
    EXPECT_EQ(why("tail_2"), "");
    EXPECT_EQ(why("tail_3"), "no_bone_tail_3");
    EXPECT_EQ(why("hand.L"), "no_bone_forearm_lower.L");
    EXPECT_EQ(why("shin.L"), "leg_drawn_into_the_belly");
    limb.mesh.rest.col(0).array() += 10.0;
    EXPECT_EQ(why("tail_2"), "no_flesh_round_the_joint");
    EXPECT_TRUE(experiments::limb_joints(limb).empty());
    for (const char* body : {"limb", "bar", "human", "man", "lady", "ring", ""})
        EXPECT_TRUE(experiments::joints_by_hand(body).empty()) << body;
}

struct Section {
    int winding;
    analysis::OutlineSize size;
};

Vec3 direction(const pbs::Bone& bone)
{
    return (bone.tail - bone.head).normalized();
}

Section section_across(const pbs::Character& body, const experiments::LimbJoint& joint, double offset_m,
                       const Vec3& normal)
{
    const Vec3 point =
        joint.point + offset_m * direction(body.skeleton.bones[offset_m < 0.0 ? joint.parent : joint.child]);
    const auto outlines =
        pbs::section_outlines(body.mesh.rest, pbs::boundary_of(body.mesh.tets), {{point, normal}}).front();
    const pbs::Positions* own = analysis::enclosing_outline(outlines, {point, normal});
    return own ? Section{analysis::winding_number(*own, {point, normal}), analysis::outline_size(*own)}
               : Section{0, {}};
}

// The section belongs to one limb: the outline encloses the bone, and no point is farther from its middle than 2.2 of
// the joint's radii; the trunk has four. The planes cover 3 radii on each side, like those of JointSections.
TEST(JointsByHand, SectionsOfFrankieAreOneLimbs)
{
    if (!pbs::body_is_installed("frankie")) GTEST_SKIP() << "pbskin fetch frankie";
    const pbs::Character frankie = pbs::make_character({.body = "frankie"});
    const auto joints = experiments::limb_joints(frankie);
    ASSERT_EQ(joints.size(), 5u);
    for (const auto& joint : joints)
        for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
            const double offset_m =
                share * std::min(2.0 * joint.radius_m, share < 0.0 ? joint.reach_parent_m : joint.reach_child_m);
            const double turned = 0.5 + offset_m / (6.0 * joint.radius_m);
            const Vec3 normal = (1.0 - turned) * direction(frankie.skeleton.bones[joint.parent]) +
                                turned * direction(frankie.skeleton.bones[joint.child]);
            const Section section = section_across(frankie, joint, offset_m, normal);
            EXPECT_EQ(std::abs(section.winding), 1) << joint.name << " " << share;
            EXPECT_LT(section.size.largest_radius_m, 2.2 * joint.radius_m) << joint.name << " " << share;
            EXPECT_GT(section.size.smallest_radius_m, 0.4 * joint.radius_m) << joint.name << " " << share;
        }
}

TEST(JointsByHand, KneeOfFrankieLiesInTheTrunk)
{
    if (!pbs::body_is_installed("frankie")) GTEST_SKIP() << "pbskin fetch frankie";
    const pbs::Character frankie = pbs::make_character({.body = "frankie"});
    const int thigh = pbs::find_bone(frankie.skeleton, "thigh.L"), shin = pbs::find_bone(frankie.skeleton, "shin.L");
    const experiments::LimbJoint knee{"thigh.L|shin.L", thigh, shin, frankie.skeleton.bones[shin].head, 0.0, 0.0, 0.0};
    const Vec3 along = frankie.skeleton.bones[shin].tail - knee.point;
    const double trunk_m2 = section_across(frankie, knee, 0.25 * along.norm(), along.normalized()).size.area_m2;
    const double ankle_m2 = section_across(frankie, knee, 0.7 * along.norm(), along.normalized()).size.area_m2;
    EXPECT_GT(trunk_m2, 10.0 * ankle_m2);
}

}  // namespace
