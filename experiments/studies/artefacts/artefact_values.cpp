#include "experiments/studies/artefacts/artefact_values.hpp"

#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/artefacts/smoothness_comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace experiments {
namespace {

using Extreme = double SectionExtremesOverRest::*;

constexpr const char* nearly_incompressible = "nh_p2_nu_049";  // shows how flesh that keeps its volume performs under the claims' bounds

// The samples of one group in one pose at one joint. The first one is of the own mesh and, for the reference, of the highest element order.
std::vector<ArtefactSample> chosen(const std::vector<ArtefactSample>& samples, const std::string& group, std::size_t pose,
                                   std::size_t joint)
{
    std::vector<ArtefactSample> chosen;
    for (const ArtefactSample& sample : samples)
        if (sample.group == group && sample.pose == pose && sample.joint == joint) chosen.push_back(sample);
    std::stable_sort(chosen.begin(), chosen.end(), [](const auto& a, const auto& b) { return a.element_order > b.element_order; });
    return chosen;
}

std::vector<double> sizes(const std::vector<ArtefactSample>& samples, Extreme extreme)
{
    std::vector<double> sizes;
    for (const ArtefactSample& sample : samples) sizes.push_back(sample.extremes.*extreme);
    return sizes;
}

double least(const std::vector<double>& values)
{
    return *std::min_element(values.begin(), values.end());
}

double most(const std::vector<double>& values)
{
    return *std::max_element(values.begin(), values.end());
}

bool is_wide(const std::vector<ArtefactSample>& samples)
{
    return !samples.empty() && most(sizes(samples, &SectionExtremesOverRest::largest_radius)) > widest_over_rest;
}

// "pbs 7.56 times as wide as at rest, 34 % of that outline the limb's own skin"
std::string remark_on_width(const std::vector<ArtefactSample>& samples, std::size_t pose, std::size_t joint)
{
    std::vector<std::string> remarks;
    for (const std::string group : {"pbs", "lbs", "dqs", "reference"}) {
        const std::vector<ArtefactSample> own = chosen(samples, group, pose, joint);
        if (!is_wide(own)) continue;
        const SectionExtremesOverRest widest = std::max_element(own.begin(), own.end(), [](const auto& a, const auto& b) {
                                                   return a.extremes.largest_radius < b.extremes.largest_radius;
                                               })->extremes;
        remarks.push_back(fmt::format("{} {:.3g} times as wide as at rest, {:.0f} % of that outline the limb's own skin", group,
                                      widest.largest_radius, 100.0 * widest.limb_share_of_widest));
    }
    return fmt::format("{}", fmt::join(remarks, "; "));
}

analysis::CaseKey key_of(const ArtefactCase& of, const ArtefactBody& body, std::size_t pose, std::size_t joint, const std::string& group)
{
    analysis::CaseKey key = of.poses[pose].key;
    key.body = body.posed.character().name;
    key.joint = body.joints[joint].name;
    key.deformer = group;
    return key;
}

std::string reference_name(const std::vector<ArtefactSample>& samples, std::size_t pose, std::size_t joint)
{
    const std::vector<ArtefactSample> reference = chosen(samples, "reference", pose, joint);
    return reference.empty() ? "" : fmt::format("nh_p{}", reference.front().element_order);
}

}  // namespace

std::vector<analysis::Measurement> candy_wrapper_values(const ArtefactCase& of, const ArtefactBody& body,
                                                        const std::vector<ArtefactSample>& samples)
{
    std::vector<analysis::Measurement> measurements;
    for (const auto& [pose, joint, reference, outcome, remark] : section_outcomes(of, body, samples))
        for (const std::string group : {"pbs", "lbs", "dqs", "reference", nearly_incompressible})
            for (const auto& [quantity, extreme] :
                 {std::pair{"smallest_section_radius_over_rest", &SectionExtremesOverRest::smallest_radius},
                  {"smallest_section_area_over_rest", &SectionExtremesOverRest::smallest_area}}) {
                const std::vector<double> values = sizes(chosen(samples, group, pose, joint), extreme);
                if (values.empty()) continue;
                analysis::CaseKey key = key_of(of, body, pose, joint, group);
                if (group == "reference") key.reference = reference;
                measurements.push_back({"C04", quantity, key, values.front(), least(values), most(values), "1"});
            }
    return measurements;
}

std::vector<analysis::Measurement> bulge_values(const ArtefactCase& of, const ArtefactBody& body,
                                                const std::vector<ArtefactSample>& samples)
{
    std::vector<analysis::Measurement> measurements;
    for (const auto& [pose, joint, reference_name, outcome, remark] : section_outcomes(of, body, samples)) {
        if (outcome != SectionOutcome::measured && outcome != SectionOutcome::pbs_did_not_finish) continue;
        for (const auto& [quantity, extreme] :
             {std::pair{"largest_section_radius_over_reference", &SectionExtremesOverRest::largest_radius},
              {"largest_section_area_over_reference", &SectionExtremesOverRest::largest_area}}) {
            const std::vector<double> reference = sizes(chosen(samples, "reference", pose, joint), extreme);
            for (const std::string group : {"pbs", "lbs", "dqs", nearly_incompressible}) {
                const std::vector<ArtefactSample> own = chosen(samples, group, pose, joint);
                if (own.empty()) continue;
                const std::vector<double> values = sizes(own, extreme);
                analysis::CaseKey key = key_of(of, body, pose, joint, group);
                key.reference = reference_name;
                measurements.push_back({"C05", quantity, key, values.front() / reference.front(), least(values) / most(reference),
                                        most(values) / least(reference), "1"});
            }
        }
    }
    return measurements;
}

const char* name_of(SectionOutcome outcome)
{
    static constexpr const char* names[] = {"measured", "pbs_did_not_finish", "reference_not_reached", "bent_by_more_than_110_deg",
                                            "inside_another_part"};
    return names[static_cast<int>(outcome)];
}

std::vector<JudgedSection> section_outcomes(const ArtefactCase& of, const ArtefactBody& body, const std::vector<ArtefactSample>& samples)
{
    const bool over_reference = of.claim == ArtefactCase::Claim::bulge;
    std::vector<JudgedSection> sections;
    for (std::size_t pose = 0; pose < of.poses.size(); ++pose)
        for (std::size_t joint = 0; joint < body.joints.size(); ++joint) {
            JudgedSection section{pose, joint, reference_name(samples, pose, joint)};
            if (over_reference && body.sections[joint].bend_deg(body.posed.pose(pose)) > deepest_bend_deg)
                section.outcome = SectionOutcome::bent_too_far;
            else if (over_reference && section.reference.empty())
                section.outcome = SectionOutcome::reference_not_reached;
            else if (over_reference && is_wide(chosen(samples, "reference", pose, joint)))
                section.outcome = SectionOutcome::inside_another_part;
            else if (chosen(samples, "pbs", pose, joint).empty())
                section.outcome = SectionOutcome::pbs_did_not_finish;
            if (over_reference && section.outcome != SectionOutcome::bent_too_far) section.remark = remark_on_width(samples, pose, joint);
            sections.push_back(section);
        }
    return sections;
}

namespace {

nlohmann::json joints_by_hand_of(const ArtefactCase& of)
{
    nlohmann::json joints = nlohmann::json::object();
    for (const JointByHand& joint : joints_by_hand(of.scene.character.body))
        joints[name_of(joint)] = {joint.reach_parent, joint.reach_child, joint.no_section};
    return joints;
}

}  // namespace

nlohmann::json to_json(const ArtefactPose& pose)
{
    static const auto fields = OptionFields<ArtefactPose>("pose")
                                   .record("frame", &ArtefactPose::frame)
                                   .record("name", &ArtefactPose::name)
                                   .record("key", &ArtefactPose::key)
                                   .complete();
    return fields.json(pose);
}

nlohmann::json to_json(const ArtefactCase& of)
{
    static const auto fields = OptionFields<ArtefactCase>("artefacts")
                                   .record("scene", &ArtefactCase::scene)
                                   .record("poses", &ArtefactCase::poses)
                                   .record("joint", &ArtefactCase::joint)
                                   .record("claim", &ArtefactCase::claim)
                                   .record("other_vertices", &ArtefactCase::vertices)
                                   .record("second_order_poses", &ArtefactCase::second_order_poses)
                                   .constant("deepest_bend_deg", deepest_bend_deg)
                                   .constant("widest_over_rest", widest_over_rest)
                                   .constant("most_weight_iterations", most_weight_iterations)
                                   .constant("residual_tolerance", residual_tolerance)
                                   .constant("satisfied_residual", satisfied_residual)
                                   .derived("joints_by_hand", joints_by_hand_of)
                                   .complete();
    return fields.json(of);
}

const analysis::Columns<SectionRow> section_columns = {
    {"claim", &SectionRow::claim, "", "id of the claim that the section is measured for"},
    {"body", &SectionRow::body, "", "name of the body"},
    {"pose", &SectionRow::pose, "", "name of the pose"},
    {"joint", &SectionRow::joint, "", "name of the joint"},
    {"reference", &SectionRow::reference, "", "name of the reference; empty where none was reached"},
    {"outcome", &SectionRow::outcome, "", "measured, or why not"},
    {"remark", &SectionRow::remark, "", "remark on the section; empty: none"}};

std::vector<SectionRow> section_rows(const ArtefactCase& of, const ArtefactBody& body, const std::vector<JudgedSection>& sections)
{
    std::vector<SectionRow> rows;
    const auto add = [&](std::size_t pose, const std::string& joint, const std::string& reference, const std::string& outcome,
                         const std::string& remark) {
        rows.push_back({name_of(of.claim), body.posed.character().name, of.poses[pose].name, joint, reference, outcome, remark});
    };
    for (const JudgedSection& section : sections)
        add(section.pose, body.joints[section.joint].name, section.reference, name_of(section.outcome), section.remark);
    for (const JointByHand& joint : joints_by_hand(body.posed.character().name)) {
        const std::string why = why_left_out(body.posed.character(), joint);
        if (why.empty() || !(of.joint.empty() || of.joint == name_of(joint))) continue;
        for (std::size_t pose = 0; pose < of.poses.size(); ++pose) add(pose, name_of(joint), "", why, "");
    }
    return rows;
}

}  // namespace experiments
