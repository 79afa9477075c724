// The figures of C04 and C05 from the sections of all deformers: the narrowest and the widest near a joint, with the spread over meshes,
// orders and the reference's element orders. The reference is snh_p2 where it was run and reached, else snh_p1; `of` says which.
//   const auto figures = bulge_figures(of, body, records.samples);
//   section_outcomes(of, body, records.samples)   // of which pose and joint there is a figure, and why not
#pragma once

#include "analysis/measurement.hpp"
#include "experiments/studies/artefacts/artefact_case.hpp"

namespace experiments {

// All that a run of the study depends on.
nlohmann::json to_json(const ArtefactPose& pose);
nlohmann::json to_json(const ArtefactCase& of);

// of a figure: "limb, twist 90 deg, upper|forearm". Nothing is said of a group without samples.
std::vector<analysis::Measurement> candy_wrapper_figures(const ArtefactCase& of, const ArtefactBody& body,
                                                         const std::vector<ArtefactSample>& samples);
// of a figure: "limb, bend 60 deg, upper|forearm, over snh_p2". Only where the outcome is `measured`.
std::vector<analysis::Measurement> bulge_figures(const ArtefactCase& of, const ArtefactBody& body,
                                                 const std::vector<ArtefactSample>& samples);

inline constexpr double deepest_bend_deg = 110.0;  // that of rest included

inline constexpr double widest_over_rest = 3.0;  // largest radius of a section of the reference: none of a limb's own comes near

// bent_too_far: of C05, beyond it the skin is folded so deeply into the joint that a section's outline may go round both halves of the
// limb, the reference's as well. inside_another_part: of C05, an outline of the reference is that of a part that the pose itself puts the
// limb into (Frankie's forearm in his trunk). Where pbs or a blend alone is as wide, it is judged, with a remark. The profiles have all.
enum class SectionOutcome { measured, pbs_did_not_finish, reference_not_reached, bent_too_far, inside_another_part };
const char* name_of(SectionOutcome outcome);

struct JudgedSection {
    std::size_t pose = 0, joint = 0;
    std::string reference;  // "snh_p2"; empty: none reached
    SectionOutcome outcome = SectionOutcome::measured;
    std::string remark = {};  // of C05, unless bent too far: who is wider than widest_over_rest, and whose skin the outline is
};

// One a pose and joint, of the case's claim. C04 does without the reference, which stands beside.
std::vector<JudgedSection> section_outcomes(const ArtefactCase& of, const ArtefactBody& body, const std::vector<ArtefactSample>& samples);
// A line each, and one a pose for a joint by hand without section, whose outcome is the reason (why_left_out).
struct SectionRow {
    std::string claim, body, pose, joint, reference, outcome, remark;
};
extern const analysis::Columns<SectionRow> section_columns;  // sections.csv
std::vector<SectionRow> section_rows(const ArtefactCase& of, const ArtefactBody& body, const std::vector<JudgedSection>& sections);

}  // namespace experiments
