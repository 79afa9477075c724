#include "experiments/studies/artefacts/artefact_values.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/settings/recorded_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::Smoothness;
using analysis::within;

using Extreme = double SectionExtremesOverRest::*;

constexpr const char* nearly_incompressible =
    "nh_p2_nu_049";  // shows how flesh that keeps its volume performs under the claims' bounds

// The samples of one group in one pose at one joint. The first one is of the own mesh and, for the reference, of the
// highest element order.
std::vector<ArtefactSample> chosen(const std::vector<ArtefactSample>& samples, const std::string& group,
                                   std::size_t pose, std::size_t joint)
{
    std::vector<ArtefactSample> chosen;
    for (const ArtefactSample& sample : samples)
        if (sample.group == group && sample.pose == pose && sample.joint == joint) chosen.push_back(sample);
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const auto& a, const auto& b) { return a.element_order > b.element_order; });
    return chosen;
}

// By order and precision of projection, which only PBS has; the own mesh comes first.
std::map<std::pair<std::string, std::string>, std::vector<ArtefactSample>> by_order(
    const std::vector<ArtefactSample>& samples)
{
    std::map<std::pair<std::string, std::string>, std::vector<ArtefactSample>> orders;
    for (const ArtefactSample& sample : samples) orders[{sample.order, sample.precision}].push_back(sample);
    return orders;
}

std::vector<double> sizes(const std::vector<ArtefactSample>& samples, Extreme extreme)
{
    std::vector<double> sizes;
    for (const ArtefactSample& sample : samples) sizes.push_back(sample.extremes.*extreme);
    return sizes;
}

bool is_wide(const std::vector<ArtefactSample>& samples)
{
    return !samples.empty() &&
           std::ranges::max(sizes(samples, &SectionExtremesOverRest::largest_radius)) > widest_over_rest;
}

// "pbs 7.56 times as wide as at rest, 34 % of that outline the limb's own skin"
std::string remark_on_width(const std::vector<ArtefactSample>& samples, std::size_t pose, std::size_t joint)
{
    std::vector<std::string> remarks;
    for (const std::string group : {"pbs", "lbs", "dqs", "reference"}) {
        const std::vector<ArtefactSample> own = chosen(samples, group, pose, joint);
        if (!is_wide(own)) continue;
        const auto radius = [](const ArtefactSample& sample) { return sample.extremes.largest_radius; };
        const SectionExtremesOverRest widest = std::ranges::max(own, {}, radius).extremes;
        remarks.push_back(
            fmt::format("{} {:.3g} times as wide as at rest, {:.0f} % of that outline the limb's own skin", group,
                        widest.largest_radius, 100.0 * widest.limb_share_of_widest));
    }
    return fmt::format("{}", fmt::join(remarks, "; "));
}

analysis::CaseKey key_of(const ArtefactCase& artefact_case, const ArtefactBody& body, std::size_t pose,
                         const std::string& joint, const std::string& deformer)
{
    analysis::CaseKey key = artefact_case.poses[pose].key;
    key.body = body.posed.character().name;
    key.joint = joint;
    key.deformer = deformer;
    return key;
}

std::string reference_name(const std::vector<ArtefactSample>& samples, std::size_t pose, std::size_t joint)
{
    const std::vector<ArtefactSample> reference = chosen(samples, "reference", pose, joint);
    return reference.empty() ? "" : fmt::format("nh_p{}", reference.front().element_order);
}

nlohmann::json joints_by_hand_of(const ArtefactCase& artefact_case)
{
    nlohmann::json joints = nlohmann::json::object();
    for (const JointByHand& joint : joints_by_hand(artefact_case.scene.character.body))
        joints[name_of(joint)] = {joint.reach_parent, joint.reach_child, joint.no_section};
    return joints;
}

constexpr double rounding = 1e-12;  // a smaller value is that of the rest pose

ArtefactBody with_weights(ArtefactBody body, pbs::Weights weights)
{
    body.posed.set_weights(std::move(weights));
    return body;
}

// The body's weights, but near each joint its two bones have each other's: within a quarter of a bone, so that the
// strain jumps inside the region in which it is measured.
pbs::Weights exchanged_weights(const ArtefactBody& body)
{
    pbs::Weights weights = body.posed.character().weights;
    for (const LimbJoint& joint : body.joints) {
        const std::vector<bool> near = near_joint(body.posed.character(), joint, 0.25);
        for (int v = 0; v < weights.vertices(); ++v)
            for (int i = weights.first[v]; near[v] && i < weights.first[v + 1]; ++i) {
                int& bone = weights.bone[i];
                bone = bone == joint.parent ? joint.child : bone == joint.child ? joint.parent : bone;
            }
    }
    return weights;
}

class Comparison {
public:
    explicit Comparison(const ArtefactCase& artefact_case) : of_(artefact_case) {}

    // weights: those of `body`: paper, or a control's.
    void compare(const ArtefactBody& body, const ArtefactBody& rigid, const DeformerSpec& spec,
                 const std::string& weights = "paper")
    {
        const Shapes own = body.posed.shapes(spec), of_rigid = rigid.posed.shapes(spec);
        const ArtefactDeformer deformer = recorded(spec);
        const auto key_at = [&](std::size_t pose, const std::string& joint) {
            analysis::CaseKey key = key_of(of_, body, pose, joint, spec.kind);
            key.order = deformer.order;
            key.precision = deformer.precision;
            key.variant = weights == "paper" ? "default" : weights + "_weights";
            return key;
        };
        for (std::size_t pose = 0; pose < own.size(); ++pose) {
            if (!own[pose].finished || !of_rigid[pose].finished) continue;
            for (std::size_t joint = 0; joint < body.joints.size(); ++joint) {
                if (!is_turned(of_.poses[pose], body, joint)) continue;
                const Smoothness smooth = measure(body, spec, own[pose], pose, joint, weights),
                                 rough = measure(rigid, spec, of_rigid[pose], pose, joint, "rigid");
                if (weights != "paper") result_.smoothness.pop_back();  // rigid weights are recorded once
                add("strain_jump_over_rigid_weights", key_at(pose, body.joints[joint].name), smooth.strain_jump_rms,
                    rough.strain_jump_rms);
                add("curvature_over_rigid_weights", key_at(pose, body.joints[joint].name), smooth.bending_rms_rad,
                    rough.bending_rms_rad);
            }
        }
    }

    WeightsComparison result() &&
    {
        for (const auto& [of, ratios] : ratios_) {
            const double own = ratios.front();
            if (!std::isfinite(own)) continue;
            analysis::Measurement measurement{"C06", of.first, of.second, own, own, own, "1"};
            for (const double ratio : ratios) {
                measurement.low = std::fmin(measurement.low, ratio);
                measurement.high = std::fmax(measurement.high, ratio);
            }
            result_.measurements.push_back(measurement);
        }
        return std::move(result_);
    }

private:
    void add(const std::string& quantity, const analysis::CaseKey& at, double paper, double rigid)
    {
        ratios_[{quantity, at}].push_back(rigid > rounding ? paper / rigid : analysis::not_known);
    }

    static double volume_change_pct(const ArtefactBody& body, const Shape& shape)
    {
        const pbs::TetMesh& mesh = body.posed.character().mesh;
        return analysis::MeshMetrics(mesh.rest, mesh.tets).measure(shape.positions).volume_abs_change_pct;
    }

    analysis::Smoothness measure(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape,
                                 std::size_t pose, std::size_t joint, const std::string& weights)
    {
        const pbs::Character& character = body.posed.character();
        const analysis::SmoothnessMetrics smoothness_metrics(character.mesh.rest, character.mesh.tets,
                                                             near_joint(character, body.joints[joint]));
        const analysis::Smoothness smoothness = smoothness_metrics.measure(shape.positions);
        result_.smoothness.push_back({character.name, static_cast<int>(character.mesh.rest.rows()), weights,
                                      of_.poses[pose].name, body.joints[joint].name, recorded(spec), smoothness,
                                      volume_change_pct(body, shape)});
        return smoothness;
    }

    const ArtefactCase& of_;
    // By quantity and the key: the ratios on each mesh, the own mesh first. Not a number where there is none.
    std::map<std::pair<std::string, analysis::CaseKey>, std::vector<double>> ratios_;
    WeightsComparison result_;
};

}  // namespace

std::vector<analysis::Measurement> section_values(const ArtefactCase& artefact_case, const ArtefactBody& body,
                                                  const std::vector<ArtefactSample>& samples)
{
    const bool is_bulge = artefact_case.claim == ArtefactCase::Claim::bulge;
    const Extreme extreme =
        is_bulge ? &SectionExtremesOverRest::largest_radius : &SectionExtremesOverRest::smallest_radius;
    const char* quantity = is_bulge ? "largest_section_radius_over_reference" : "smallest_section_radius_over_rest";
    std::vector<analysis::Measurement> measurements;
    for (const auto& [pose, joint, reference_name, outcome, remark] : section_outcomes(artefact_case, body, samples)) {
        if (outcome != SectionOutcome::measured && outcome != SectionOutcome::pbs_did_not_finish) continue;
        const std::vector<double> base =
            is_bulge ? sizes(chosen(samples, "reference", pose, joint), extreme) : std::vector{1.0};
        for (const std::string group : {"pbs", "lbs", "dqs", "pbs_author", "reference", nearly_incompressible}) {
            if (is_bulge && group == "reference") continue;
            for (const auto& [order, own] : by_order(chosen(samples, group, pose, joint))) {
                const std::vector<double> values = sizes(own, extreme);
                analysis::CaseKey key = key_of(artefact_case, body, pose, body.joints[joint].name, group);
                std::tie(key.order, key.precision) = order;
                if (is_bulge || group == "reference") key.reference = reference_name;
                measurements.push_back({name_of(artefact_case.claim), quantity, key, values.front() / base.front(),
                                        std::ranges::min(values) / std::ranges::max(base),
                                        std::ranges::max(values) / std::ranges::min(base), "1"});
            }
        }
    }
    return measurements;
}

const char* name_of(SectionOutcome outcome)
{
    static constexpr const char* names[] = {"measured", "pbs_did_not_finish", "reference_not_reached",
                                            "bent_by_more_than_110_deg", "inside_another_part"};
    return names[static_cast<int>(outcome)];
}

std::vector<JudgedSection> section_outcomes(const ArtefactCase& artefact_case, const ArtefactBody& body,
                                            const std::vector<ArtefactSample>& samples)
{
    const bool over_reference = artefact_case.claim == ArtefactCase::Claim::bulge;
    std::vector<JudgedSection> sections;
    for (std::size_t pose = 0; pose < artefact_case.poses.size(); ++pose)
        for (std::size_t joint = 0; joint < body.joints.size(); ++joint) {
            if (!is_turned(artefact_case.poses[pose], body, joint)) continue;
            JudgedSection section{pose, joint, reference_name(samples, pose, joint)};
            if (over_reference && body.sections[joint].bend_deg(body.posed.pose(pose)) > deepest_bend_deg)
                section.outcome = SectionOutcome::bent_too_far;
            else if (over_reference && section.reference.empty())
                section.outcome = SectionOutcome::reference_not_reached;
            else if (over_reference && is_wide(chosen(samples, "reference", pose, joint)))
                section.outcome = SectionOutcome::inside_another_part;
            else if (chosen(samples, "pbs", pose, joint).empty())
                section.outcome = SectionOutcome::pbs_did_not_finish;
            if (over_reference && section.outcome != SectionOutcome::bent_too_far)
                section.remark = remark_on_width(samples, pose, joint);
            sections.push_back(section);
        }
    return sections;
}

RECORD_SETTINGS(ArtefactPose, frame, name, key, turned)

RECORD_SETTINGS_AND(ArtefactCase,
                    .record("other_vertices", &ArtefactCase::vertices)
                        .constant("deepest_bend_deg", deepest_bend_deg)
                        .constant("widest_over_rest", widest_over_rest)
                        .derived("joints_by_hand", joints_by_hand_of),
                    scene, poses, joint, claim, second_order_poses, through_sweep)

const analysis::Columns<SectionRow> section_columns =
    MEMBER_COLUMNS(SectionRow, claim, body, pose, joint, reference, outcome, remark);

std::vector<SectionRow> section_rows(const ArtefactCase& artefact_case, const ArtefactBody& body,
                                     const std::vector<JudgedSection>& sections)
{
    std::vector<SectionRow> rows;
    const auto add = [&](std::size_t pose, const std::string& joint, const std::string& reference,
                         const std::string& outcome, const std::string& remark) {
        rows.push_back({name_of(artefact_case.claim), body.posed.character().name, artefact_case.poses[pose].name,
                        joint, reference, outcome, remark});
    };
    for (const JudgedSection& section : sections)
        add(section.pose, body.joints[section.joint].name, section.reference, name_of(section.outcome), section.remark);
    for (const JointByHand& joint : joints_by_hand(body.posed.character().name)) {
        const std::string why = why_left_out(body.posed.character(), joint);
        if (why.empty() || !(artefact_case.joint.empty() || artefact_case.joint == name_of(joint))) continue;
        for (std::size_t pose = 0; pose < artefact_case.poses.size(); ++pose)
            if (artefact_case.poses[pose].turned.empty() ||
                std::ranges::count(artefact_case.poses[pose].turned, joint.child) > 0)
                add(pose, name_of(joint), "", why, "");
    }
    return rows;
}

const Columns<SmoothnessRow> smoothness_columns =
    MEMBER_COLUMNS(SmoothnessRow, body, vertices, weights, pose, joint) +
    within(&SmoothnessRow::deformer, artefact_deformer_columns) +
    within(&SmoothnessRow::smoothness, MEMBER_COLUMNS(Smoothness, strain_jump_rms, bending_rms_rad)) +
    Columns<SmoothnessRow>{{"volume_abs_change_pct", &SmoothnessRow::volume_abs_change_pct}};

WeightsComparison compare_weights(const ArtefactCase& artefact_case)
{
    Comparison comparison(artefact_case);
    const DeformerSpec pbs = spec_of(artefact_case.scene, "pbs");
    DeformerSpec plain = pbs;
    options_of<pbs::PbsOptions>(plain).order = pbs::Order::plain;
    options_of<pbs::PbsOptions>(plain).precision = pbs::Precision::f64;
    std::vector<DeformerSpec> specs = other_orders(pbs);
    specs.insert(specs.begin(), {spec_of(artefact_case.scene, "lbs"), pbs});
    ArtefactCase by_eq_2 = artefact_case;
    by_eq_2.scene.character.weights = pbs::WeightKind::paper;
    std::vector<int> meshes = {0};
    meshes.insert(meshes.end(), artefact_case.vertices.begin(), artefact_case.vertices.end());
    for (const int vertices : meshes) {
        const ArtefactBody paper(by_eq_2, vertices);
        const ArtefactBody rigid =
            with_weights(paper, pbs::weights_by(pbs::WeightKind::rigid, paper.posed.character()));
        for (const DeformerSpec& spec : specs) comparison.compare(paper, rigid, spec);
        if (vertices != 0) continue;
        const pbs::Weights diffused = pbs::weights_by(pbs::WeightKind::diffused, paper.posed.character());
        for (const DeformerSpec& spec : {specs.front(), plain}) {
            comparison.compare(with_weights(paper, exchanged_weights(paper)), rigid, spec, "exchanged");
            comparison.compare(with_weights(paper, diffused), rigid, spec, "diffused");
        }
    }
    return std::move(comparison).result();
}

}  // namespace experiments
