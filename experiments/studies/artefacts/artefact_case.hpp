// One body, turned at a joint or in poses of a clip, under all deformers, as it is examined for the artefacts of
// blending.
//   const ArtefactRecords records = find_artefacts(of, body);
//   table_of(profile_columns, records.profiles).write("profiles.csv");
// Every deformer of the scene runs on the body's own mesh, PBS also in the other orders and precisions. The same,
// except what no claim selects, runs on the body's other meshes. Their spread is the range of a value.
#pragma once

#include "analysis/metrics/cross_section.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/meshes/meshing.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <string>
#include <vector>

namespace experiments {

// The joints of a body that lie inside a limb, and the axes about which each is turned to show what blending does to
// it.
//   for (const LimbJoint& joint : limb_joints(character)) ...   // elbow, mid-forearm, wrist, knee
struct LimbJoint {
    std::string name;   // "thigh.L|shin.L"
    int parent, child;  // bones
    pbs::Vec3 point;    // rest [m]
    double radius_m;    // of the limb there: mean rest distance of the skin's vertices that are bound to the two bones
    double reach_parent_m, reach_child_m;  // how far along each bone sections are taken
};

// A joint lies between two bones that meet at less than 60 degrees at rest and share their flesh with no other bone
// (frame_measurement.hpp). Its reach is half of each bone. Bodies with two sides have the joints of their left side (x
// >= 0). Where the rule misjudges the bones, the joints are given by hand (joints_by_hand); their radius is that of the
// circle with the area of the section across the joint.
std::vector<LimbJoint> limb_joints(const pbs::Character& character);

// A joint given by its bones, and the share of each bone on which a section's outline encloses the limb alone.
struct JointByHand {
    std::string parent, child;
    double reach_parent, reach_child;
    std::string no_section;  // why it has no section; empty: it has
};
std::string name_of(const JointByHand& joint);
// Why the character has no sections there: no_section, or a bone or flesh that it lacks. Empty: it has sections.
std::string why_left_out(const pbs::Character& character, const JointByHand& joint);
std::vector<JointByHand> joints_by_hand(const std::string& body);  // none: the body follows the rule

pbs::Vec3 twist_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint);  // the child's direction

// Across both bones, so that a turn about it bends the limb further in the direction in which it is bent at rest; z for
// a straight limb.
pbs::Vec3 hinge_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint);

// The vertices of the two bones that are no farther from the joint, along the bone, than this share of its length, #V.
std::vector<bool> near_joint(const pbs::Character& character, const LimbJoint& joint, double share = 1.0 / 3.0);

// Cross-sections of a limb from one side of a joint to the other, in any pose, relative to rest.
//   const JointSections sections(character, joint);
//   sections.measure(positions, pose);            // a profile, one section per station
//   extremes_of(profile).smallest_radius;         // of the narrowest section, over the same at rest
// Stations lie on the bones, up to 2 limb radii or the joint's reach away from it. Over 3 radii on each side, their
// planes turn evenly from the direction of one bone to that of the other. On the inside of a joint that is bent by an
// angle they meet 6 radii / angle away from it, so that they do not cut the limb's other half. The planes move with the
// bones and are the same for all deformers. Only the limb's own outline is measured, the one that encloses the bone.
// Where the skin is folded deeply into a joint, this outline may enclose both halves.
struct JointSection {
    double offset_m = 0.0;  // from the joint in the rest pose, negative on the parent
    double area = 1.0, smallest_radius = 1.0, largest_radius = 1.0;  // over the same station's at rest
    int outlines = 0;                                                // that the plane cuts out of the whole body
    double limb_share = 1.0;  // share of the outline's length whose skin is bound to the parent or a bone below it
};
using JointProfile = std::vector<JointSection>;

struct SectionExtremesOverRest {
    double smallest_radius = 1.0, largest_radius = 1.0;
    double limb_share_of_widest = 1.0;  // where the largest radius is
};
SectionExtremesOverRest extremes_of(const JointProfile& profile);

class JointSections {
public:
    JointSections(const pbs::Character& character, const LimbJoint& joint);

    double bend_deg(const pbs::Pose& pose) const;  // between the directions of the two bones; 0: straight

    // A station whose plane no longer meets the skin has size 0.
    JointProfile measure(const pbs::Positions& positions, const pbs::Pose& pose) const;

private:
    std::vector<pbs::CuttingPlane> planes(const pbs::Pose& pose) const;
    struct Cut {
        analysis::OutlineSize size = {};
        int outlines = 0;
        double limb_share = 1.0;
    };
    std::vector<Cut> cuts(const pbs::Positions& positions, const pbs::Pose& pose) const;

    pbs::Skeleton skeleton_;
    LimbJoint joint_;
    pbs::Triangles skin_;
    std::vector<bool> on_limb_;  // #V
    std::vector<double> offsets_m_;
    std::vector<Cut> rest_;  // of each station
};

struct ArtefactPose {
    int frame = 0;
    std::string name;                      // twist_90_deg, 01_01_crouch
    analysis::CaseKey key = {};            // motion, angle or pose
    std::vector<std::string> turned = {};  // the bones whose joints are looked at; empty: all
};

struct ArtefactCase {
    enum class Claim { candy_wrapper, bulge };  // C04, C05

    Scene scene;  // with lbs, dqs, pbs, pbs_author, nh_p1 and others; its reference is nh_p1
    std::vector<ArtefactPose> poses;
    std::string joint;           // LimbJoint::name; empty: all of them
    Claim claim = Claim::bulge;  // for which the sections are measured
    std::vector<int> vertices;   // wanted sizes of the other meshes
    int second_order_poses = 0;  // the first poses, in which quadratic elements are solved too, if the scene has them
    // The sections of the scene's deformers alone, and of PBS after all frames of the sweep up to the pose, on which a
    // PBS with a memory depends.
    bool through_sweep = false;
};

template <>
inline constexpr NameTable<ArtefactCase::Claim, 2> option_names<ArtefactCase::Claim>{
    {{ArtefactCase::Claim::candy_wrapper, "C04"}, {ArtefactCase::Claim::bulge, "C05"}}};

// The body on one mesh.
struct ArtefactBody {
    explicit ArtefactBody(const ArtefactCase& artefact_case, int vertices = 0);  // 0: those of the scene

    PosedCharacter posed;
    std::vector<LimbJoint> joints;
    std::vector<JointSections> sections;  // of each joint
};

// Whether the pose turns the joint, so that it is looked at there.
bool is_turned(const ArtefactPose& pose, const ArtefactBody& body, std::size_t joint);

// The extremes of one deformer's sections in one pose at one joint.
struct ArtefactSample {
    std::string group;  // the kind of deformer; reference: flesh with the reference's Poisson's ratio; with another
                        // one: the label
    std::size_t pose = 0, joint = 0;
    SectionExtremesOverRest extremes;
    int element_order = 0;                   // of the reference
    std::string order = {}, precision = {};  // of PBS
};

// The place and the deformer of a row.
struct ArtefactPlace {
    std::string body;
    int vertices = 0;
    std::string pose;
};
struct ArtefactDeformer {
    std::string deformer, order, precision;  // order and precision: for PBS only
};
inline const analysis::Columns<ArtefactPlace> artefact_place_columns =
    MEMBER_COLUMNS(ArtefactPlace, body, vertices, pose);
inline const analysis::Columns<ArtefactDeformer> artefact_deformer_columns =
    MEMBER_COLUMNS(ArtefactDeformer, deformer, order, precision);
ArtefactDeformer recorded(const DeformerSpec& spec);

struct ProfileRow {
    ArtefactPlace place;
    std::string joint;
    ArtefactDeformer deformer;
    JointSection section;
};
struct IntersectionRow {
    ArtefactPlace place;
    ArtefactDeformer deformer;
    std::string surface;
    int triangles = 0, pairs = 0, pairs_at_rest = 0;
};
extern const analysis::Columns<ProfileRow> profile_columns;            // profiles.csv
extern const analysis::Columns<IntersectionRow> intersection_columns;  // intersections.csv

struct ArtefactRecords {
    std::vector<ArtefactSample> samples;  // in each group, order, pose and joint the own mesh comes first
    std::vector<ProfileRow> profiles;
    std::vector<IntersectionRow> intersections;
    std::string breakdown;  // deformers that did not finish
};

// PBS with the same options in every other order and precision.
std::vector<DeformerSpec> other_orders(const DeformerSpec& pbs);

ArtefactRecords find_artefacts(const ArtefactCase& artefact_case, const ArtefactBody& body);

}  // namespace experiments
