// One body, turned at a joint or in poses of a clip, under all deformers, as it is examined for the artefacts of blending.
//   const ArtefactRecords records = find_artefacts(of, body);
//   table_of(profile_columns, records.profiles).write("profiles.csv");
// Every deformer of the scene runs on the body's own mesh. PBS also runs in the other orders and precisions; PBS, the blends and the
// reference also run on the body's other meshes. Their spread is the uncertainty of a value.
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/studies/artefacts/joint_sections.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <array>
#include <string>
#include <vector>

namespace experiments {

struct ArtefactPose {
    int frame = 0;
    std::string name;            // twist_90_deg, 01_01_crouch
    analysis::CaseKey key = {};  // motion, angle or pose
};

struct ArtefactCase {
    enum class Claim { candy_wrapper, bulge };  // C04, C05

    Scene scene;  // with lbs, dqs, pbs, nh_p1 and others; its reference is nh_p1
    std::vector<ArtefactPose> poses;
    std::string joint;           // LimbJoint::name; empty: all of them
    Claim claim = Claim::bulge;  // for which the sections are measured
    std::vector<int> vertices;   // wanted sizes of the other meshes
    int second_order_poses = 0;  // the first poses, in which quadratic elements are solved too, if the scene has them
};

template <>
struct OptionNames<ArtefactCase::Claim> {
    static constexpr std::array<std::pair<ArtefactCase::Claim, const char*>, 2> table{
        {{ArtefactCase::Claim::candy_wrapper, "C04"}, {ArtefactCase::Claim::bulge, "C05"}}};
};

// The body on one mesh.
struct ArtefactBody {
    explicit ArtefactBody(const ArtefactCase& of, int vertices = 0);  // 0: those of the scene

    PosedCharacter posed;
    std::vector<LimbJoint> joints;
    std::vector<JointSections> sections;  // of each joint
};

// The extremes of one deformer's sections in one pose at one joint.
struct ArtefactSample {
    std::string group;  // pbs, in any order and precision; reference, for flesh with the reference's Poisson's ratio; otherwise the label
    std::size_t pose = 0, joint = 0;
    SectionExtremesOverRest extremes;
    int element_order = 0;  // of the reference
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
inline const analysis::Columns<ArtefactPlace> artefact_place_columns = {{"body", &ArtefactPlace::body, "", "name of the body"},
                                                                        {"vertices", &ArtefactPlace::vertices, "", "vertices of its mesh"},
                                                                        {"pose", &ArtefactPlace::pose, "", "name of the pose"}};
inline const analysis::Columns<ArtefactDeformer> artefact_deformer_columns = {
    {"deformer", &ArtefactDeformer::deformer, "", "name of the deformer"},
    {"order", &ArtefactDeformer::order, "", "PBS: order of projection"},
    {"precision", &ArtefactDeformer::precision, "", "PBS: f32 or f64"}};
ArtefactPlace place_of(const ArtefactCase& of, const ArtefactBody& body, std::size_t pose);
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
    std::vector<ArtefactSample> samples;  // in each group, pose and joint the own mesh and the default order come first
    std::vector<ProfileRow> profiles;
    std::vector<IntersectionRow> intersections;
    std::string breakdown;  // deformers that did not finish
};

// PBS with the same options in every other order and precision.
std::vector<DeformerSpec> other_orders(const DeformerSpec& pbs);

ArtefactRecords find_artefacts(const ArtefactCase& of, const ArtefactBody& body);

}  // namespace experiments
