// C05 from a limb bent by 30 and 60 degrees, compared with neo-Hookean elements, with the correct solver in the order
// of the file and double precision, with broken ones and with a blend in its place. Reference:
// - nothing projected: LBS remains, whose crease bulges to the sides: wider than the reference.
// - DQS in its place: the bulge of the claim, a ridge across the joint.
// - bind or stretch dropped: the crease of LBS changes tets, and the volume constraints reverse it with the class that
//   is left. Without volume constraints nothing is expected: edges alone do not determine a section, and its radius
//   depends on the sequence of projections.
// - volume sign: every projection doubles the error that it should remove, so nothing keeps its size.
// - flesh too thick: the solver's own rest state is 1.2 times as thick around the joint, and its tets are 1.44 times as
//   large there, as all constraints require. By geometry, sections are 1.2 times as wide and 1.44 times as large at
//   rest, and bending changes a section of the correct solver by far less.
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/artefact_samples.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace broken_bulge_tests {
namespace {

using namespace analysis;
using namespace test_support;
using experiments::ArtefactSample;
using experiments::Shapes;

experiments::ArtefactCase small_bend()
{
    experiments::ArtefactCase of;
    of.scene = experiments::read_scene(
        "limb_bend", {"character.vertices=1200", "motion.angle_deg=60", "motion.frames=3", "pbs.order=plain",
                      "pbs.precision=f64", R"(deformers.use=["lbs", "dqs", "pbs", "nh_p1"])"});
    of.claim = experiments::ArtefactCase::Claim::bulge;
    of.poses = {{1, "bend_30_deg", {.angle_deg = 30.0}}, {2, "bend_60_deg", {.angle_deg = 60.0}}};
    return of;
}

struct BentLimb {
    experiments::ArtefactCase of = small_bend();
    experiments::ArtefactBody body{of};
    Shapes reference = shapes("nh_p1");

    Shapes shapes(const std::string& deformer) const { return body.posed.shapes(spec_of(of.scene, deformer)); }
};

const BentLimb& limb()
{
    static const BentLimb limb;
    return limb;
}

Shapes solved(Broken how, pbs::Order order = pbs::Order::plain)
{
    experiments::DeformerSpec spec = spec_of(limb().of.scene, "pbs");
    auto& options = experiments::options_of<pbs::PbsOptions>(spec);
    options.order = order;
    options = broken(options, how);
    return limb().body.posed.shapes(spec);
}

void add_samples(const std::string& group, const Shapes& shapes, int element_order,
                 std::vector<ArtefactSample>& samples)
{
    for (std::size_t pose = 0; pose < shapes.size(); ++pose) {
        ASSERT_TRUE(shapes[pose].finished) << group;
        const auto profile = limb().body.sections.at(0).measure(shapes[pose].positions, limb().body.posed.pose(pose));
        samples.push_back(sample(group, pose, 0.0, element_order));
        samples.back().extremes = extremes_of(profile);
    }
}

// The values with these shapes in place of the solver's.
std::vector<Measurement> measure(const Shapes& shapes)
{
    std::vector<ArtefactSample> samples;
    add_samples("pbs", shapes, 0, samples);
    add_samples("reference", limb().reference, 1, samples);
    return section_values(limb().of, limb().body, samples);
}

// In how many of the two poses there is no bulge.
int without_bulge(const std::vector<Measurement>& measured)
{
    const Judged own = own_cases("C05", measured);
    EXPECT_EQ(own.n, 2);
    return own.held;
}

// Every vertex around the joint is farther from its bone.
pbs::Character thickened(pbs::Character character, double factor)
{
    const std::vector<bool> near = near_joint(character, limb().body.joints.at(0));
    for (std::size_t v = 0; v < near.size(); ++v) {
        if (!near[v]) continue;
        const auto on_bone = character.binding.rest_point.row(v);
        character.mesh.rest.row(v) = on_bone + factor * (character.mesh.rest.row(v) - on_bone);
        character.binding.distance(v) *= factor;
    }
    return character;
}

Shapes solved_with(const pbs::Character& character, const std::vector<pbs::Pose>& poses)
{
    const auto deformer = make_deformer(spec_of(limb().of.scene, "pbs"));
    deformer->reset(character);
    Shapes shapes;
    for (const pbs::Pose& pose : poses) {
        const bool finished = deformer->advance(pose, 0.01).outcome == pbs::Outcome::finished;
        shapes.push_back({deformer->positions(), finished});
    }
    return shapes;
}

std::vector<pbs::Pose> bent_poses()
{
    return {limb().body.posed.pose(0), limb().body.posed.pose(1)};
}

constexpr double thicker = 1.2;

TEST(BrokenBulge, AsItIsThereIsNone)
{
    EXPECT_EQ(without_bulge(measure(solved(Broken::nothing))), 2);
    // The correct solver, driven by hand like the thick one below, gives the same result.
    const Shapes again = solved_with(limb().body.posed.character(), bent_poses()), own = solved(Broken::nothing);
    for (std::size_t pose = 0; pose < own.size(); ++pose) EXPECT_EQ(again.at(pose).positions, own[pose].positions);
}

// The widest section of a bent limb near its joint, computed differently from JointSections: the points at which a
// plane crosses the edges of the skin are ordered by their angle about the bone. This is valid for limbs that are cut
// once, in an outline that is star-shaped about the bone.

std::vector<Eigen::Vector2d> crossings(const pbs::Positions& positions, const pbs::Triangles& skin,
                                       const pbs::Vec3& point, const pbs::Vec3& normal)
{
    const pbs::Vec3 u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
    std::vector<Eigen::Vector2d> found;
    for (const auto triangle : skin.rowwise())
        for (int corner = 0; corner < 3; ++corner) {
            const pbs::Vec3 a = positions.row(triangle(corner)), b = positions.row(triangle((corner + 1) % 3));
            const double below = (a - point).dot(normal), above = (b - point).dot(normal);
            // each edge only once; in its other triangle it runs from b to a
            if (!(below < 0.0 && above >= 0.0)) continue;
            const pbs::Vec3 at = (above * a - below * b) / (above - below) - point;
            found.push_back({at.dot(u), at.dot(v)});
        }
    std::sort(found.begin(), found.end(),
              [](const auto& p, const auto& q) { return std::atan2(p.y(), p.x()) < std::atan2(q.y(), q.x()); });
    return found;
}

double largest_radius_m(const std::vector<Eigen::Vector2d>& outline)
{
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    double length = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Eigen::Vector2d &p = outline[i], &q = outline[(i + 1) % outline.size()];
        moment += 0.5 * (q - p).norm() * (p + q);
        length += (q - p).norm();
    }
    for (const Eigen::Vector2d& p : outline) largest = std::max(largest, (p - moment / length).norm());
    return largest;
}

// The plane passes through the bone, `offset_m` from the joint; within 3 radii on each side it turns from one bone's
// direction to the other's.
double hand_cut(const experiments::ArtefactBody& body, const pbs::Positions& positions, const pbs::Pose& pose,
                double offset_m)
{
    const experiments::LimbJoint& joint = body.joints.at(0);
    const auto& bones = body.posed.character().skeleton.bones;
    const auto along = [&](int bone) { return pbs::Vec3((bones[bone].tail - bones[bone].head).normalized()); };
    const int carrier = offset_m < 0.0 ? joint.parent : joint.child;
    const double turned = 0.5 + offset_m / (6.0 * joint.radius_m);
    const pbs::Vec3 before = pose[joint.parent].linear() * along(joint.parent),
                    after = pose[joint.child].linear() * along(joint.child);
    const pbs::Vec3 point = pose[carrier] * pbs::Vec3(joint.point + offset_m * along(carrier));
    return largest_radius_m(crossings(positions, body.posed.boundary(), point, before + turned * (after - before)));
}

// The largest radius over all stations, each relative to its own section at rest.
double hand_cut_widest(const experiments::ArtefactBody& body, const pbs::Positions& positions, const pbs::Pose& pose)
{
    const pbs::Positions& rest = body.posed.character().mesh.rest;
    const pbs::Pose still(pose.size(), Eigen::Isometry3d::Identity());
    double widest = 0.0;
    for (const experiments::JointSection& section : body.sections.at(0).measure(rest, still))
        widest = std::max(
            widest, hand_cut(body, positions, pose, section.offset_m) / hand_cut(body, rest, still, section.offset_m));
    return widest;
}

// A point at which a plane cuts an edge goes through six roundings, and the heights of the edge's ends through eight,
// on both sides.
template <typename Value>
double of_cuts(const pbs::Positions& positions, Value value)
{
    return value_rounding(positions, coordinate_rounding_m(positions, 2 * (6 + 8)), value);
}

TEST(BrokenBulge, ValuesAreTheRatiosOfSectionsCutByHand)
{
    const Shapes own = solved(Broken::nothing);
    const auto measured = measure(own);
    for (std::size_t pose = 0; pose < own.size(); ++pose) {
        const auto by_hand = [&](const pbs::Positions& positions) {
            return hand_cut_widest(limb().body, positions, limb().body.posed.pose(pose));
        };
        const pbs::Positions &shape = own[pose].positions, &reference = limb().reference[pose].positions;
        const double expected = by_hand(shape) / by_hand(reference);
        EXPECT_NEAR(measured.at(pose).value, expected,
                    (of_cuts(shape, by_hand) + expected * of_cuts(reference, by_hand)) / by_hand(reference));
    }
}

TEST(BrokenBulge, DualQuaternionsInItsPlaceBulge)
{
    EXPECT_EQ(without_bulge(measure(limb().shapes("dqs"))), 0);
}

TEST(BrokenBulge, NothingProjectedIsLbs)
{
    const auto measured = measure(solved(Broken::nothing_projected)), lbs = measure(limb().shapes("lbs"));
    ASSERT_EQ(measured.size(), lbs.size());
    for (std::size_t i = 0; i < lbs.size(); ++i) {
        const auto value = [i](const pbs::Positions& positions) {
            Shapes rounded = limb().shapes("lbs");
            for (std::size_t pose = 0; pose < rounded.size(); ++pose)
                rounded[pose].positions += positions - limb().body.posed.character().mesh.rest;
            return measure(rounded).at(i).value;
        };
        const pbs::Positions& rest = limb().body.posed.character().mesh.rest;
        // Positions go through 24 roundings of two motions, on both sides.
        EXPECT_NEAR(measured[i].value, lbs[i].value, value_rounding(rest, coordinate_rounding_m(rest, 2 * 24), value));
    }
    EXPECT_EQ(without_bulge(measured), 0);
}

TEST(BrokenBulge, FleshTakenTooThickRoundTheJointIsABulge)
{
    EXPECT_EQ(without_bulge(measure(solved_with(thickened(limb().body.posed.character(), thicker), bent_poses()))), 0);
}

// This shape satisfies every constraint, so the solver leaves it unchanged. Sections farther away than a radius have
// thin neighbours.
TEST(BrokenBulge, AtRestItIsAsThickAsItWasTaken)
{
    const pbs::Pose still(2, Eigen::Isometry3d::Identity());
    const Shapes rest = solved_with(thickened(limb().body.posed.character(), thicker), {still});
    // Each of many projections rounds in double, all of them together by less than one rounding to float.
    const auto of_float = [&](double offset_m, double experiments::JointSection::*size) {
        const pbs::Positions thick = thickened(limb().body.posed.character(), thicker).mesh.rest;
        return value_rounding(thick, single_rounding_m(thick), [&](const pbs::Positions& positions) {
            for (const auto& section : limb().body.sections.at(0).measure(positions, still))
                if (section.offset_m == offset_m) return section.*size;
            return std::nan("");
        });
    };
    int sections = 0;
    for (const auto& section : limb().body.sections.at(0).measure(rest.at(0).positions, still)) {
        if (std::abs(section.offset_m) > limb().body.joints.at(0).radius_m) continue;
        EXPECT_NEAR(section.largest_radius, thicker,
                    of_float(section.offset_m, &experiments::JointSection::largest_radius));
        EXPECT_NEAR(section.area, thicker * thicker, of_float(section.offset_m, &experiments::JointSection::area));
        ++sections;
    }
    EXPECT_GE(sections, 9);
}

TEST(BrokenBulge, TheSignTurnedRoundBulges)
{
    EXPECT_EQ(without_bulge(measure(solved(Broken::volume_sign))), 0);
}

TEST(BrokenBulge, WithoutBindOrStretchTheOthersStillTakeItBack)
{
    const auto lbs = measure(limb().shapes("lbs"));
    for (const Broken how : {Broken::bind_dropped, Broken::stretch_dropped})
        for (const pbs::Order order : {pbs::Order::ordered, pbs::Order::plain}) {
            const auto measured = measure(solved(how, order));
            EXPECT_EQ(without_bulge(measured), 2) << name_of(how);
            for (std::size_t pose = 0; pose < lbs.size(); ++pose) EXPECT_LT(measured.at(pose).value, lbs[pose].value);
        }
}

}  // namespace
}  // namespace broken_bulge_tests
