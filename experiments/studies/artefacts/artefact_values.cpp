#include "experiments/studies/artefacts/artefact_values.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/settings/recorded_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::Smoothness;
using analysis::within;

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

bool is_wide(const std::vector<ArtefactSample>& samples)
{
    return !samples.empty() && std::ranges::max(sizes(samples, &SectionExtremesOverRest::largest_radius)) > widest_over_rest;
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
        remarks.push_back(fmt::format("{} {:.3g} times as wide as at rest, {:.0f} % of that outline the limb's own skin", group,
                                      widest.largest_radius, 100.0 * widest.limb_share_of_widest));
    }
    return fmt::format("{}", fmt::join(remarks, "; "));
}

analysis::CaseKey key_of(const ArtefactCase& of, const ArtefactBody& body, std::size_t pose, const std::string& joint,
                         const std::string& deformer)
{
    analysis::CaseKey key = of.poses[pose].key;
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

nlohmann::json joints_by_hand_of(const ArtefactCase& of)
{
    nlohmann::json joints = nlohmann::json::object();
    for (const JointByHand& joint : joints_by_hand(of.scene.character.body))
        joints[name_of(joint)] = {joint.reach_parent, joint.reach_child, joint.no_section};
    return joints;
}

Columns<Reached> reached_columns(const std::string& name, const std::string& weights)
{
    return {{"iterations_" + name, &Reached::iterations, "", "iterations to tolerance with " + weights},
            {"reached_" + name, &Reached::within, "", "they reached it"}};
}

constexpr double rounding = 1e-12;  // a smaller value is that of the rest pose

struct Twin {
    ArtefactBody paper, rigid;
};

Twin twin_of(ArtefactCase of, int vertices)
{
    of.scene.character.weights = pbs::WeightKind::paper;
    ArtefactBody paper(of, vertices);
    of.scene.character.weights = pbs::WeightKind::rigid;
    of.scene.character.weights_file.clear();
    return {std::move(paper), ArtefactBody(of, vertices)};
}

// The ratios of one quantity over meshes and orders, the own mesh and order first. Not a number where there is none.
struct Ratios {
    std::vector<double> values = {};
    analysis::Limit limit = analysis::Limit::none;  // of the first value
};

class Comparison {
public:
    explicit Comparison(const ArtefactCase& of) : of_(of) {}

    void compare(const Twin& twin, const DeformerSpec& spec)
    {
        const Shapes paper = twin.paper.posed.shapes(spec), rigid = twin.rigid.posed.shapes(spec);
        for (std::size_t pose = 0; pose < paper.size(); ++pose) {
            if (!paper[pose].finished || !rigid[pose].finished) continue;
            for (std::size_t joint = 0; joint < twin.paper.joints.size(); ++joint) {
                const analysis::Smoothness smooth = measure(twin.paper, spec, paper[pose], pose, joint, "paper"),
                                           rough = measure(twin.rigid, spec, rigid[pose], pose, joint, "rigid");
                const analysis::CaseKey at = key_of(of_, twin.paper, pose, twin.paper.joints[joint].name, spec.kind);
                add("strain_jump_over_rigid_weights", at, smooth.strain_jump_rms, rough.strain_jump_rms);
                add("curvature_over_rigid_weights", at, smooth.bending_rms_rad, rough.bending_rms_rad);
            }
            if (options_if<pbs::PbsOptions>(spec))
                add("volume_abs_change_over_rigid_weights", key_of(of_, twin.paper, pose, of_.joint, "pbs"),
                    volume_change_pct(twin.paper, paper[pose]), volume_change_pct(twin.rigid, rigid[pose]));
        }
    }

    // The weights affect only the initial guess of the solver: two guesses lead to one limit.
    void compare_convergence(const Twin& twin, const pbs::PbsOptions& options)
    {
        const pbs::Character &paper = twin.paper.posed.character(), &rigid = twin.rigid.posed.character();
        for (std::size_t pose = 0; pose < of_.poses.size(); ++pose) {
            const pbs::Pose& now = twin.paper.posed.pose(pose);
            const pbs::Positions bind_points = pbs::posed_bind_points(paper.binding, now);
            const std::vector<IterationPath> paths = iterate(paper, options, bind_points, {blended(paper, now), blended(rigid, now)},
                                                             most_weight_iterations, IterationMetrics(paper, bind_points));
            const double floor = floor_of(paths);
            add_iterations(twin, pose, reached_residual(paths[0], floor), reached_residual(paths[1], floor));
        }
    }

    WeightsComparison result() &&
    {
        for (const auto& [of, ratios] : ratios_) {
            const double own = ratios.values.front();
            if (!std::isfinite(own)) continue;
            analysis::Measurement measurement{"C06", of.first, of.second, own, own, own, "1"};
            measurement.limit = ratios.limit;
            for (const double ratio : ratios.values) {
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
        ratios_[{quantity, at}].values.push_back(rigid > rounding ? paper / rigid : analysis::not_known);
    }

    // An initial guess within the tolerance counts as one iteration. Where neither path reaches it there is no ratio.
    void add_iterations(const Twin& twin, std::size_t pose, const Reached& paper, const Reached& rigid)
    {
        result_.iterations.push_back({place_of(of_, twin.paper, pose), paper, rigid});
        Ratios& ratios = ratios_[{"iterations_over_rigid_weights", key_of(of_, twin.paper, pose, of_.joint, "pbs")}];
        const bool some = paper.within || rigid.within;
        if (ratios.values.empty() && some && paper.within != rigid.within)
            ratios.limit = paper.within ? analysis::Limit::at_most : analysis::Limit::at_least;
        ratios.values.push_back(some ? std::max(paper.iterations, 1) / double(std::max(rigid.iterations, 1)) : analysis::not_known);
    }

    static double volume_change_pct(const ArtefactBody& body, const Shape& shape)
    {
        const pbs::TetMesh& mesh = body.posed.character().mesh;
        return analysis::MeshMetrics(mesh.rest, mesh.tets).measure(shape.positions).volume_abs_change_pct;
    }

    analysis::Smoothness measure(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape, std::size_t pose,
                                 std::size_t joint, const std::string& weights)
    {
        const pbs::Character& character = body.posed.character();
        const analysis::SmoothnessMetrics smoothness_metrics(character.mesh.rest, character.mesh.tets,
                                                             near_joint(character, body.joints[joint]));
        const analysis::Smoothness smoothness = smoothness_metrics.measure(shape.positions);
        result_.smoothness.push_back({character.name, static_cast<int>(character.mesh.rest.rows()), weights, of_.poses[pose].name,
                                      body.joints[joint].name, recorded(spec), smoothness, volume_change_pct(body, shape)});
        return smoothness;
    }

    const ArtefactCase& of_;
    std::map<std::pair<std::string, analysis::CaseKey>, Ratios> ratios_;  // by quantity and the key
    WeightsComparison result_;
};

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
                analysis::CaseKey key = key_of(of, body, pose, body.joints[joint].name, group);
                if (group == "reference") key.reference = reference;
                measurements.push_back({"C04", quantity, key, values.front(), std::ranges::min(values), std::ranges::max(values), "1"});
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
                analysis::CaseKey key = key_of(of, body, pose, body.joints[joint].name, group);
                key.reference = reference_name;
                measurements.push_back({"C05", quantity, key, values.front() / reference.front(),
                                        std::ranges::min(values) / std::ranges::max(reference),
                                        std::ranges::max(values) / std::ranges::min(reference), "1"});
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

RECORD_SETTINGS(ArtefactPose, frame, name, key)

RECORD_SETTINGS_AND(ArtefactCase,
                    .record("other_vertices", &ArtefactCase::vertices)
                        .constant("deepest_bend_deg", deepest_bend_deg)
                        .constant("widest_over_rest", widest_over_rest)
                        .constant("most_weight_iterations", most_weight_iterations)
                        .constant("residual_tolerance", residual_tolerance)
                        .constant("satisfied_residual", satisfied_residual)
                        .derived("joints_by_hand", joints_by_hand_of),
                    scene, poses, joint, claim, second_order_poses)

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

const Columns<SmoothnessRow> smoothness_columns =
    Columns<SmoothnessRow>{{"body", &SmoothnessRow::body, "", "name of the body"},
                           {"vertices", &SmoothnessRow::vertices, "", "vertices of its mesh"},
                           {"weights", &SmoothnessRow::weights, "", "paper: Eq. 2; rigid: every vertex on its nearest bone alone"},
                           {"pose", &SmoothnessRow::pose, "", "name of the pose"},
                           {"joint", &SmoothnessRow::joint, "", "name of the joint"}} +
    within(&SmoothnessRow::deformer, artefact_deformer_columns) +
    within(
        &SmoothnessRow::smoothness,
        Columns<Smoothness>{
            {"strain_jump_rms", &Smoothness::strain_jump_rms, "", "root mean square jump of strain between neighbouring tets at the joint"},
            {"bending_rms_rad", &Smoothness::bending_rms_rad, "rad", "root mean square bending of the skin at the joint"}}) +
    Columns<SmoothnessRow>{{"volume_abs_change_pct", &SmoothnessRow::volume_abs_change_pct, "%", "sum of the tets' absolute changes"}};

const Columns<WeightIterations> weight_iteration_columns = within(&WeightIterations::place, artefact_place_columns) +
                                                           within(&WeightIterations::paper, reached_columns("paper", "Eq. 2")) +
                                                           within(&WeightIterations::rigid, reached_columns("rigid", "rigid weights"));

WeightsComparison compare_weights(const ArtefactCase& of)
{
    Comparison comparison(of);
    std::vector<int> meshes = {0};
    meshes.insert(meshes.end(), of.vertices.begin(), of.vertices.end());
    const DeformerSpec pbs = spec_of(of.scene, "pbs");
    for (const int vertices : meshes) {
        const Twin twin = twin_of(of, vertices);
        comparison.compare(twin, spec_of(of.scene, "lbs"));
        comparison.compare(twin, pbs);
        comparison.compare_convergence(twin, options_of<pbs::PbsOptions>(pbs));
        if (vertices != 0) continue;
        for (const DeformerSpec& other : other_orders(pbs)) comparison.compare(twin, other);
    }
    return std::move(comparison).result();
}

}  // namespace experiments
