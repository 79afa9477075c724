#include "experiments/run/metrics_table.hpp"

#include "experiments/deformers/registry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::ErrorNorms;
using analysis::FrameMetrics;
using analysis::within;

const char *const with_reference = "reference", *const with_error_bar = "error_bar", *const with_sleep = "sleep";

}  // namespace

const Columns<FrameMetrics>& frame_metric_columns()
{
    static const Columns<FrameMetrics> columns = {
        {"volume_change_pct", &FrameMetrics::volume_change_pct, "%",
         "signed change of the whole volume; the paper's E = V0 - V' has the opposite sign"},
        {"volume_abs_change_pct", &FrameMetrics::volume_abs_change_pct, "%",
         "sum of the absolute changes of all tets, so that gains do not hide losses"},
        {"inverted_tets", &FrameMetrics::inverted_tets, "", "number of inverted or flattened tets"},
        {"mean_abs_j_minus_1", &FrameMetrics::mean_abs_j_minus_1, "", "mean relative change of volume, weighted by rest volume"},
        {"j_min", &FrameMetrics::j_min, "", "smallest volume of a tet over its volume at rest; negative if the tet is inverted"},
        {"stretch_rms", &FrameMetrics::stretch_rms, "", "residual of the stretch constraints"}};
    return columns;
}

namespace {

const Columns<ErrorNorms> error_columns = {
    {"error_l2_pct", &ErrorNorms::l2_pct, "%", "distance to the reference over free vertices"},
    {"error_joint_pct", &ErrorNorms::joint_pct, "%",
     "distance to the reference over the vertices that Eq. 2 blends: this number distinguishes deformers"},
    {"error_linf_m", &ErrorNorms::linf_m, "m", "largest distance to the reference"}};

const Columns<ErrorNorms> whole_error_columns = {
    {"error_whole_l2_pct", &ErrorNorms::l2_pct, "%", "error_l2_pct with the part of the body where the reference overlaps itself"},
    {"error_whole_joint_pct", &ErrorNorms::joint_pct, "%", "error_joint_pct with that part"}};

const Columns<FrameMeasurement> masked_columns = {
    {"masked_share_pct", &FrameMeasurement::masked_share_pct, "%",
     "share of the volume that the errors leave out because the reference overlaps itself there; no deformer has contact"}};

const Columns<ErrorNorms> error_bar_columns = {
    {"reference_error_l2_pct", &ErrorNorms::l2_pct, "%",
     "bound of the reference's distance from the limit of ever finer tets over free vertices, by the method of reference.error_bar"},
    {"reference_error_joint_pct", &ErrorNorms::joint_pct, "%",
     "bound of the reference's distance from that limit over the vertices that Eq. 2 blends"},
    {"reference_error_linf_m", &ErrorNorms::linf_m, "m", "bound of the reference's largest distance from that limit"}};

const Columns<FrameMeasurement> measured_columns =
    within(&FrameMeasurement::metrics, frame_metric_columns()) +
    Columns<FrameMeasurement>{{"bind_rms_m", &FrameMeasurement::bind_rms_m, "m", "residual of the bind constraints"}};

const Columns<FrameMeasurement> pose_columns = {{"angle_deg", &FrameMeasurement::angle_deg, "deg", "angle of a sweep; empty for clips"},
                                                {"rotation_deg", &FrameMeasurement::rotation_deg, "deg",
                                                 "largest rotation of a bone relative to the root; linear strain is right only near zero"}};

const Columns<FrameMeasurement> shape_columns = {
    {"min_section_pct", &FrameMeasurement::min_section_pct, "%",
     "smallest cross-section of a limb over its area at rest; it measures the candy wrapper artefact"},
    {"surface_volume_change_pct", &FrameMeasurement::surface_volume_change_pct, "%",
     "change of the volume inside the rendered surface, which the tets carry"}};

using Rows = Columns<MetricRow>;
const Rows all_columns =
    Rows{{"scene", &MetricRow::scene, "", "name of the scene"},
         {"deformer", &MetricRow::deformer, "", "name of the deformer"},
         {"variant", &MetricRow::variant, "", "reading or printed form of the method, or default"},
         {"order", &MetricRow::order, "", "order of projection; empty if the deformer has none"},
         {"precision", &MetricRow::precision, "", "f32 or f64"},
         {"iterations", &MetricRow::iterations, "", "iterations per step, those of all substeps; empty if the deformer has none"},
         {"threads", &MetricRow::threads, "", "number of threads"},
         {"frame", &MetricRow::frame, "", "number of the frame, from 0"},
         {"time_s", &MetricRow::time_s, "s", "time since the motion began"}} +
    within(&MetricRow::measured, measured_columns) +
    Rows{{"step_ms", &MetricRow::step_ms, "ms", "wall time of the deformer for this frame, without measuring and writing"}} +
    within(&MetricRow::measured, within(&FrameMeasurement::errors, error_columns) +
                                     within(&FrameMeasurement::errors_on_whole_body, whole_error_columns) + masked_columns)
        .in_group(with_reference) +
    within(&MetricRow::measured, pose_columns) +
    Rows{{"fictitious_strain", &MetricRow::fictitious_strain, "",
          "the strain that linear elasticity computes for that rotation; in the rows of linear FEM"}} +
    within(&MetricRow::measured, shape_columns) +
    Rows{{"outcome", &MetricRow::outcome, "",
          "how the step ended; not_converged: PBS above its stop_residual, or a reference that did not reach its pose and has no error "
          "there"}} +
    (within(&MetricRow::measured, within(&FrameMeasurement::reference_error, error_bar_columns)) +
     Rows{{"error_below_reference_error", &MetricRow::error_below_reference_error, "",
           "the error may be the reference's own, so that it does not distinguish deformers; empty in the reference's rows"}})
        .in_group(with_error_bar) +
    Rows{{"sleeping_share", &MetricRow::sleeping_share, "", "share of the stretch and volume constraints that were left out"},
         {"wakings", &MetricRow::wakings, "", "how often the step was repeated because some of them were needed"}}
        .in_group(with_sleep);

const std::string volume = "V: signed volume of all tets; V0: at rest", tet_volume = "V_t: signed volume of tet t; V0_t: at rest";
const std::string of_all = "V0: volume of all tets at rest", ratio = "J_t = V_t / V0_t: volume of tet t over its volume at rest";
const std::string positions = "x_i: position of vertex i; xref_i: in the reference", masses = "m_i: rest volume lumped to vertex i";
const std::string free_vertices = "i: vertices that nothing prescribes, outside the overlap (masked_share_pct)",
                  blended = "i: vertices that Eq. 2 blends between bones, outside the overlap (masked_share_pct)";

struct Formula {
    std::string formula, source, cost;
    std::vector<std::string> symbols = {};
};

const std::map<std::string, Formula> formulae = {
    {"volume_change_pct", {"100 (V - V0) / V0", "Sec. 4", "one pass over the tets", {volume}}},
    {"volume_abs_change_pct", {"100 sum_t |V_t - V0_t| / V0", "Sec. 4, the other reading", "with volume_change_pct", {tet_volume, of_all}}},
    {"inverted_tets", {"number of tets t with V_t <= 0", "", "with volume_change_pct", {tet_volume}}},
    {"mean_abs_j_minus_1", {"sum_t V0_t |J_t - 1| / V0", "", "with volume_change_pct", {ratio, of_all}}},
    {"j_min", {"min_t J_t", "", "with volume_change_pct", {ratio}}},
    {"stretch_rms", {"rms_e(l_e / l0_e - 1)", "Eq. 10", "one pass over the edges", {"l_e: length of edge e; l0_e: at rest"}}},
    {"bind_rms_m",
     {"rms_i(|x_i - q_i| - d_i)",
      "Sec. 3.6",
      "one pass over the vertices",
      {"x_i: position of vertex i", "q_i: where it projects on its bone at rest, carried along by the bone",
       "d_i: distance of the two at rest"}}},
    {"step_ms", {"wall time of the frame's step", "Table 1", ""}},
    {"error_l2_pct",
     {"100 sqrt(sum_i m_i |x_i - xref_i|^2 / sum_i m_i) / D",
      "",
      "one pass over the vertices",
      {positions, masses, free_vertices, "D: diagonal of the bounding box at rest"}}},
    {"error_joint_pct",
     {"100 sqrt(sum_i m_i |x_i - xref_i|^2 / sum_i m_i) / (sum_i m_i d_i / sum_i m_i)",
      "",
      "with error_l2_pct",
      {positions, masses, blended, "d_i: distance of vertex i to its bone at rest"}}},
    {"error_linf_m", {"max_i |x_i - xref_i|", "", "with error_l2_pct", {positions, free_vertices}}},
    {"error_whole_l2_pct", {"as error_l2_pct, over all vertices that nothing prescribes", "", "with error_l2_pct"}},
    {"error_whole_joint_pct", {"as error_joint_pct, over all vertices that Eq. 2 blends", "", "with error_l2_pct"}},
    {"masked_share_pct",
     {"100 sum_i m_i / sum_j m_j",
      "",
      "a point location per vertex of the skin",
      {masses,
       "i: skin vertices inside another part of the body or at an inverted tet, vertices within one limb radius of them, and those of "
       "inverted "
       "tets",
       "j: all vertices"}}},
    {"reference_error_l2_pct",
     {"bound of reference.error_bar in the norm of error_l2_pct: grid convergence index with two solutions, Richardson's estimate with "
      "four",
      "P. J. Roache 1994, I. B. Celik et al. 2008, L. Eca, M. Hoekstra 2014",
      "the reference solved once or three times more; seconds in run.json"}},
    {"reference_error_joint_pct", {"the same bound in the norm of error_joint_pct", "", "with reference_error_l2_pct"}},
    {"reference_error_linf_m", {"the same bound in the norm of error_linf_m", "", "with reference_error_l2_pct"}},
    {"error_below_reference_error", {"error_joint_pct <= reference_error_joint_pct (l2 where nothing is blended)", "", ""}},
    {"rotation_deg", {"largest angle between a bone's rotation and the root's", "", ""}},
    {"fictitious_strain", {"1 - cos(rotation_deg)", "", ""}},
    {"outcome", {"finished, not_finite or not_converged", "", ""}},
    {"angle_deg", {"angle_deg i / (frames - 1)", "", "", {"i: the frame; angle_deg, frames: of the scene's [motion]"}}},
    {"min_section_pct",
     {"100 min_s A_s / A0_s",
      "Fig. 3, 8",
      "plane cuts of the limbs' tets",
      {"A_s: area of the cross-section at station s of a limb; A0_s: at rest"}}},
    {"surface_volume_change_pct",
     {"100 (S - S0) / S0",
      "Sec. 1",
      "one pass over the surface",
      {"S: volume inside the rendered surface, by the divergence theorem; S0: at rest"}}}};

}  // namespace

MetricRow metric_row(const Scene& scene, const DeformerSpec& spec, int frame, double time_s, const FrameMeasurement& measured,
                     const pbs::StepSummary& step)
{
    const DeformerTraits traits = traits_of(spec);
    MetricRow row{.scene = scene.name, .deformer = spec.name, .variant = spec.variant};
    row.order = traits.order;
    row.precision = traits.precision;
    row.iterations = traits.iterations;
    row.threads = traits.threads;
    row.frame = frame;
    row.time_s = time_s;
    row.measured = measured;
    row.step_ms = 1e3 * step.seconds;
    // Linear strain of a rigid rotation by theta: cos(theta) - 1 along the two axes across it.
    if (traits.has_small_strain) row.fictitious_strain = 1.0 - std::cos(measured.rotation_deg * std::numbers::pi / 180.0);
    row.outcome = to_string(step.outcome);
    if (measured.reference_error && spec.name != scene.reference)  // the reference's own row has no difference that could be below
        row.error_below_reference_error = measured.error_below_reference_error();
    row.sleeping_share = step.sleeping_share;
    row.wakings = step.wakings;
    return row;
}

const analysis::Columns<MetricRow>& metric_columns()
{
    return all_columns;
}

analysis::Columns<MetricRow> metric_columns_of(const Scene& scene)
{
    analysis::Columns<MetricRow> columns = all_columns;
    const auto sleeps = [](const DeformerSpec& spec) { return traits_of(spec).sleeps; };
    if (scene.reference.empty()) columns = columns.without(with_reference);
    if (scene.error_bar == ErrorBar::none) columns = columns.without(with_error_bar);
    if (std::none_of(scene.deformers.begin(), scene.deformers.end(), sleeps)) columns = columns.without(with_sleep);
    return columns;
}

const std::vector<MetricText>& metric_texts()
{
    static const std::vector<MetricText> all = [] {
        std::vector<MetricText> texts;
        for (const auto& column : all_columns)
            if (const auto found = formulae.find(column.name); found != formulae.end()) {
                const auto& [formula, source, cost, symbols] = found->second;
                texts.push_back({column.name, column.unit, formula, column.meaning, source, cost, symbols});
            }
        return texts;
    }();
    return all;
}

const MetricText* find_metric(const std::string& name)
{
    const auto found = std::ranges::find(metric_texts(), name, &MetricText::name);
    return found == metric_texts().end() ? nullptr : &*found;
}

}  // namespace experiments
