// The values of C04 and C05 from the sections of all deformers: the narrowest and the widest section near a joint, with
// the spread over meshes and the reference's element orders. PBS has a value in each order and precision. The reference
// is nh_p2 where it was run and reached, and nh_p1 otherwise; the key states which. Nearly incompressible flesh (nu =
// 0.49) has values of its own.
//   const auto measurements = section_values(of, body, records.samples);
//   section_outcomes(of, body, records.samples)   // which poses and joints have a value, and why the others have none
#pragma once

#include "analysis/metrics/error_norms.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/studies/artefacts/artefact_case.hpp"

namespace experiments {

// Everything that a run of the study depends on.
nlohmann::json to_json(const ArtefactPose& pose);
nlohmann::json to_json(const ArtefactCase& artefact_case);

// Of the case's claim. C04: the narrowest section over rest, also of the reference, by whose value the verdict divides
// the others. C05: the widest section over the reference's; a value requires that flesh has a section there. A group
// without samples has no value.
std::vector<analysis::Measurement> section_values(const ArtefactCase& artefact_case, const ArtefactBody& body,
                                                  const std::vector<ArtefactSample>& samples);

inline constexpr double deepest_bend_deg = 110.0;  // including the bend at rest

inline constexpr double widest_over_rest =
    3.0;  // largest radius of a reference's section; no section of a limb alone comes near it

// bent_too_far, for C05: the skin is folded so deeply into the joint that a section's outline may enclose both halves
// of the limb, for the reference as well. inside_another_part, for C05: the reference's outline is that of a part into
// which the pose itself puts the limb (Frankie's forearm in his trunk). Where only pbs or a blend is as wide, the
// section is judged, with a remark. The profiles have all sections.
enum class SectionOutcome { measured, pbs_did_not_finish, reference_not_reached, bent_too_far, inside_another_part };
const char* name_of(SectionOutcome outcome);

struct JudgedSection {
    std::size_t pose = 0, joint = 0;
    std::string reference;  // "nh_p2"; empty: none was reached
    SectionOutcome outcome = SectionOutcome::measured;
    std::string remark =
        // for C05, unless bent too far: which deformers are wider than widest_over_rest, and whose skin their outline
        // is
        {};
};

// One per pose and joint, for the case's claim. Values of C04 need no reference here.
std::vector<JudgedSection> section_outcomes(const ArtefactCase& artefact_case, const ArtefactBody& body,
                                            const std::vector<ArtefactSample>& samples);
// One row for each of them, and one per pose for a joint by hand without section, whose outcome is the reason
// (why_left_out).
struct SectionRow {
    std::string claim, body, pose, joint, reference, outcome, remark;
};
extern const analysis::Columns<SectionRow> section_columns;  // sections.csv
std::vector<SectionRow> section_rows(const ArtefactCase& artefact_case, const ArtefactBody& body,
                                     const std::vector<JudgedSection>& sections);

// C06: the same poses with the weights of Eq. 2, or of the scene's weights file in their place, and with rigid weights,
// which bind every vertex to its nearest bone alone.
//   for (const analysis::Measurement& measurement : compare_weights(of).measurements) ...
// Measured are, at each joint, the jump of strain between neighbouring tets and the bending of the skin
// (analysis/metrics/error_norms.hpp). Each value is a ratio of Eq. 2 to rigid weights, with its spread over meshes,
// with the variant default; PBS has one in each order and precision. Two controls take the place of Eq. 2 under LBS,
// and under PBS in file order and double precision, on the own mesh: exchanged_weights, in which the two bones of each
// joint have each other's weights near it, and diffused_weights (pbs/skinning/weights.hpp).

struct SmoothnessRow {
    std::string body;
    int vertices = 0;
    std::string weights, pose, joint;
    ArtefactDeformer deformer;
    analysis::Smoothness smoothness;
    double volume_abs_change_pct = 0.0;
};
extern const analysis::Columns<SmoothnessRow> smoothness_columns;  // smoothness.csv

struct WeightsComparison {
    std::vector<analysis::Measurement> measurements;
    std::vector<SmoothnessRow> smoothness;  // the terms of the ratios
};

WeightsComparison compare_weights(const ArtefactCase& artefact_case);

}  // namespace experiments
