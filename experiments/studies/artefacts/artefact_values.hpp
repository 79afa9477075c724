// The values of the claims C04, C05 and C06, from bodies under all deformers (artefact_case.hpp).
//   const ArtefactBody body(artefact_case);
//   const ArtefactRecords records = find_artefacts(artefact_case, body);
//   section_values(artefact_case, body, records.samples);     // C04 or C05, as the case's claim is
//   section_outcomes(artefact_case, body, records.samples);   // why a pose and joint has no value
//   compare_weights(artefact_case).measurements;              // C06
// A value has the range over the meshes and over the reference's element orders. PBS has a value in each order and
// precision. The reference is nh_p2 where it was run and reached, and nh_p1 otherwise; the key of the value states
// which. Nearly incompressible flesh (nu = 0.49) has values of its own.
#pragma once

#include "analysis/metrics/error_norms.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/studies/artefacts/artefact_case.hpp"

namespace experiments {

// Everything that a run of the study depends on.
nlohmann::json to_json(const ArtefactPose& pose);
nlohmann::json to_json(const ArtefactCase& artefact_case);

// The values for the case's claim. A group of samples that is empty has no value.
//   C04  The radius of the narrowest section near a joint over that at rest. The reference has such a value, too, and
//        the verdict divides the others by it.
//   C05  The radius of the widest section over that of the reference's widest section. There is no value where the
//        reference has no section.
std::vector<analysis::Measurement> section_values(const ArtefactCase& artefact_case, const ArtefactBody& body,
                                                  const std::vector<ArtefactSample>& samples);

// The largest bend of a joint for which C05 has a value. It includes the bend at rest.
inline constexpr double deepest_bend_deg = 110.0;

// The largest radius, relative to rest, of a section of the reference that is used. No section of a limb alone comes
// near it.
inline constexpr double widest_over_rest = 3.0;

// What became of the sections near one joint in one pose.
enum class SectionOutcome {
    measured,
    pbs_did_not_finish,
    reference_not_reached,
    // C05: the skin is folded so deeply into the joint that the outline of a section may enclose both halves of the
    // limb, for the reference as well.
    bent_too_far,
    // C05: the reference's outline is that of another part, into which the pose itself puts the limb, as Frankie's
    // forearm into his trunk. Where only PBS or a blend is as wide, the section is judged and has a remark.
    inside_another_part
};
const char* name_of(SectionOutcome outcome);

struct JudgedSection {
    std::size_t pose = 0, joint = 0;
    std::string reference;  // "nh_p2"; empty: none was reached
    SectionOutcome outcome = SectionOutcome::measured;
    // C05, unless bent too far: which deformers are wider than widest_over_rest, and how much of their outline is the
    // limb's own skin
    std::string remark = {};
};

// One per pose and joint, for the case's claim. Values of C04 need no reference here.
std::vector<JudgedSection> section_outcomes(const ArtefactCase& artefact_case, const ArtefactBody& body,
                                            const std::vector<ArtefactSample>& samples);

// A row of sections.csv.
struct SectionRow {
    std::string claim, body, pose, joint, reference, outcome, remark;
};
extern const analysis::Columns<SectionRow> section_columns;

// One row per judged section. A joint given by hand that has no section on this body has one row per pose, and its
// outcome is the reason (why_left_out).
std::vector<SectionRow> section_rows(const ArtefactCase& artefact_case, const ArtefactBody& body,
                                     const std::vector<JudgedSection>& sections);

// A row of smoothness.csv: one of the two terms of a ratio of C06, on one mesh near one joint in one pose.
struct SmoothnessRow {
    std::string body;
    int vertices = 0;
    std::string weights, pose, joint;  // weights: paper, rigid, exchanged, diffused
    ArtefactDeformer deformer;
    analysis::Smoothness smoothness;
    double volume_abs_change_pct = 0.0;
};
extern const analysis::Columns<SmoothnessRow> smoothness_columns;

struct WeightsComparison {
    std::vector<analysis::Measurement> measurements;
    std::vector<SmoothnessRow> smoothness;  // the terms of the ratios
};

// C06: the case's poses with the weights of Eq. 2 and with rigid weights, which bind every vertex to its nearest bone
// alone. The weights file of the scene, if there is one, takes the place of Eq. 2. Two quantities are measured near
// each joint: the jump of strain between neighbouring tets and the bending of the skin
// (analysis/metrics/error_norms.hpp). A value is the ratio of the quantity with Eq. 2 to that with rigid weights, and
// its variant is `default`. Two controls take the place of Eq. 2 on the body's own mesh, under LBS and under PBS in
// file order and double precision:
//   exchanged_weights  The two bones of each joint have each other's weights near it.
//   diffused_weights   The weights vary smoothly, since they have diffused through the flesh
//   (pbs/skinning/weights.hpp).
WeightsComparison compare_weights(const ArtefactCase& artefact_case);

}  // namespace experiments
