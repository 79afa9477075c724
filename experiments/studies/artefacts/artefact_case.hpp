// One body, turned at a joint or in poses of a clip, by all deformers: what is looked at for the artefacts of blending.
//   const ArtefactRecords records = find_artefacts(of);
//   records.profiles.write("profiles.csv");
// Every deformer of the scene is run on the body's own mesh. PBS is run in the other orders and precisions too; PBS, the blends and the
// reference on the body's other meshes: their spread is the uncertainty of a value.
#pragma once

#include "analysis/case_key.hpp"
#include "analysis/records/csv_table.hpp"
#include "experiments/studies/artefacts/joint_sections.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <array>
#include <string>
#include <vector>

namespace experiments {

struct ArtefactPose {
    int frame = 0;
    std::string name;            // "twist 90 deg", "01_01 crouch"
    analysis::CaseKey key = {};  // motion, angle or pose
};

struct ArtefactCase {
    enum class Claim { candy_wrapper, bulge };  // C04, C05

    Scene scene;  // lbs, dqs, pbs, snh_p1, others; snh_p2 where asked for
    std::vector<ArtefactPose> poses;
    std::string joint;           // LimbJoint::name; empty: all of them
    Claim claim = Claim::bulge;  // that the sections are measured for
    std::vector<int> vertices;   // wanted sizes of other meshes
    int second_order_poses = 0;  // the first so many with the reference's quadratic elements, snh_p2
};

// The body on one mesh: what is measured there.
struct ArtefactBody {
    explicit ArtefactBody(const ArtefactCase& of, int vertices = 0);  // 0: as the scene has it

    PosedCharacter posed;
    std::vector<LimbJoint> joints;
    std::vector<JointSections> sections;  // of each joint
};

// The extremes of one deformer's sections in one pose at one joint.
struct ArtefactSample {
    std::string group;  // pbs: in any order and precision; reference: snh_p1 and snh_p2; else the deformer
    std::size_t pose = 0, joint = 0;
    SectionExtremesOverRest extremes;
    int element_order = 0;  // of the reference
};

struct ArtefactRecords {
    std::vector<ArtefactSample> samples;  // of a group in a pose at a joint, the body's own mesh and the default order first
    analysis::CsvTable profiles, intersections;
    std::string breakdown;  // deformers that did not finish
};

// PBS as it is there in every other order and precision.
std::vector<DeformerSpec> other_orders(const DeformerSpec& pbs);

// Its order and precision of projection, for records; empty texts for other deformers.
std::array<std::string, 2> projection_of(const DeformerSpec& spec);

ArtefactRecords find_artefacts(const ArtefactCase& of, const ArtefactBody& body);

}  // namespace experiments
