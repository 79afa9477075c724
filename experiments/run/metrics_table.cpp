#include "experiments/run/metrics_table.hpp"

#include "analysis/records/toml_keys.hpp"
#include "experiments/deformers/registry.hpp"
#include "generated/metrics_texts.hpp"

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

const Columns<ErrorNorms> error_columns = {
    {"error_l2_pct", &ErrorNorms::l2_pct, "%", "distance to the reference over free vertices"},
    {"error_joint_pct", &ErrorNorms::joint_pct, "%",
     "distance to the reference over the vertices that Eq. 2 blends: this number distinguishes deformers"},
    {"error_linf_m", &ErrorNorms::linf_m, "m", "largest distance to the reference"}};

const Columns<ErrorNorms> whole_error_columns = {
    {"error_whole_l2_pct", &ErrorNorms::l2_pct, "%", "error_l2_pct with the tips of the reference's creases"},
    {"error_whole_joint_pct", &ErrorNorms::joint_pct, "%", "error_joint_pct with these tips"}};

const Columns<FrameMeasurement> masked_columns = {
    {"masked_share_pct", &FrameMeasurement::masked_share_pct, "%",
     "share of the volume that the errors exclude: the tips of creases of a reference with "
     "contact, whose sharpness belongs to its tets"}};

const Columns<ErrorNorms> error_bar_columns = {
    {"reference_error_l2_pct", &ErrorNorms::l2_pct, "%",
     "bound of the reference's distance from the limit of ever finer tets over free vertices, by the method of "
     "reference.error_bar"},
    {"reference_error_joint_pct", &ErrorNorms::joint_pct, "%",
     "bound of the reference's distance from that limit over the vertices that Eq. 2 blends"},
    {"reference_error_linf_m", &ErrorNorms::linf_m, "m", "bound of the reference's largest distance from that limit"}};

const Columns<FrameMeasurement> measured_columns =
    within(&FrameMeasurement::metrics, frame_metric_columns()) +
    Columns<FrameMeasurement>{{"bind_rms_m", &FrameMeasurement::bind_rms_m, "m", "residual of the bind constraints"}};

const Columns<FrameMeasurement> pose_columns = {
    {"angle_deg", &FrameMeasurement::angle_deg, "deg", "angle of a sweep; empty for clips"},
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
         {"iterations", &MetricRow::iterations, "",
          "iterations per step, those of all substeps; empty if the deformer has none"},
         {"threads", &MetricRow::threads, "", "number of threads"},
         {"frame", &MetricRow::frame, "", "number of the frame, from 0"},
         {"time_s", &MetricRow::time_s, "s",
          "time since the motion began; outcome.motion.time_zero of run.json states when that is"}} +
    within(&MetricRow::measured, measured_columns) +
    Rows{{"step_ms", &MetricRow::step_ms, "ms",
          "wall time of the deformer for this frame, without measuring and writing"}} +
    within(&MetricRow::measured, within(&FrameMeasurement::errors, error_columns) +
                                     within(&FrameMeasurement::errors_on_whole_body, whole_error_columns) +
                                     within(&FrameMeasurement::skin, skin_error_columns()) + masked_columns)
        .in_group(with_reference) +
    within(&MetricRow::measured, pose_columns) +
    Rows{{"fictitious_strain", &MetricRow::fictitious_strain, "",
          "the strain that linear elasticity computes for that rotation; in the rows of small-strain FEM"}} +
    within(&MetricRow::measured, shape_columns) +
    Rows{{"outcome", &MetricRow::outcome, "",
          "how the step ended; not_converged: PBS above its stop_residual, or a reference that did not reach its pose "
          "and has no error "
          "there"}} +
    (within(&MetricRow::measured, within(&FrameMeasurement::reference_error, error_bar_columns)) +
     Rows{{"error_below_reference_error", &MetricRow::error_below_reference_error, "",
           "the error may be the reference's own, so that it does not distinguish deformers; empty in the reference's "
           "rows"}})
        .in_group(with_error_bar) +
    Rows{{"sleeping_share", &MetricRow::sleeping_share, "",
          "share of the stretch and volume constraints that were skipped"},
         {"wakings", &MetricRow::wakings, "", "how often the step was repeated because some of them were needed"}}
        .in_group(with_sleep);

}  // namespace

const Columns<FrameMetrics>& frame_metric_columns()
{
    static const Columns<FrameMetrics> columns = {
        {"volume_change_pct", &FrameMetrics::volume_change_pct, "%",
         "signed change of the whole volume; the paper's E = V0 - V' has the opposite sign"},
        {"volume_abs_change_pct", &FrameMetrics::volume_abs_change_pct, "%",
         "sum of the absolute changes of all tets, so that gains do not hide losses"},
        {"inverted_tets", &FrameMetrics::inverted_tets, "", "number of inverted or flattened tets"},
        {"mean_abs_j_minus_1", &FrameMetrics::mean_abs_j_minus_1, "",
         "mean relative change of volume, weighted by rest volume"},
        {"j_min", &FrameMetrics::j_min, "",
         "smallest volume of a tet over its volume at rest; negative if the tet is inverted"},
        {"stretch_rms", &FrameMetrics::stretch_rms, "", "residual of the stretch constraints"}};
    return columns;
}

const Columns<analysis::SkinError>& skin_error_columns()
{
    using analysis::SkinError;
    static const Columns<SkinError> columns = {
        {"skin_rms_mm", &SkinError::rms_mm, "mm",
         "distance of the skin from the reference, where the largest extent of the body at rest is 1.7 m"},
        {"skin_p95_mm", &SkinError::p95_mm, "mm", "distance that 95 % of the skin does not exceed"},
        {"skin_largest_mm", &SkinError::largest_mm, "mm", "largest distance of the skin"},
        {"skin_rms_pct", &SkinError::rms_pct, "%",
         "the distance of skin_rms_mm in parts of the bounding box's diagonal, as papers on skinning state it"},
        {"normals_mean_deg", &SkinError::normals_mean_deg, "deg",
         "angle between the normals of the skin and of the reference, which shading shows"},
        {"normals_p95_deg", &SkinError::normals_p95_deg, "deg", "angle that 95 % of the skin does not exceed"}};
    return columns;
}

MetricRow metric_row(const Scene& scene, const DeformerSpec& spec, int frame, double time_s,
                     const FrameMeasurement& measured, const pbs::StepSummary& step)
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
    if (traits.has_small_strain)
        row.fictitious_strain = 1.0 - std::cos(measured.rotation_deg * std::numbers::pi / 180.0);
    row.outcome = to_string(step.outcome);
    // the reference's own row has no difference that could be below
    if (measured.reference_error && spec.name != scene.reference)
        row.error_below_reference_error = measured.error_below_reference_error();
    row.sleeping_share = step.sleeping_share;
    row.wakings = step.wakings;
    return row;
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
    static const std::vector<MetricText> known_texts = [] {
        const std::string file = "experiments/run/metrics.toml";
        const toml::table document = analysis::parse_toml_document(::metrics::metrics_toml, file, {"metric"});
        std::map<std::string, MetricText> formulae;
        for (const toml::table* table : analysis::toml_tables(document, "metric", file)) {
            MetricText text;
            analysis::TomlKeys keys(*table, file, "metric");
            keys.required("name", text.name);
            keys.required("formula", text.formula);
            keys.optional("unit", text.unit);
            keys.optional("meaning", text.meaning);
            keys.optional("source", text.source);
            keys.optional("cost", text.cost);
            keys.optional("symbols", text.symbols);
            keys.require_nothing_unknown();
            formulae[text.name] = text;
        }
        std::vector<MetricText> texts;
        for (const auto& column : all_columns)
            if (const auto found = formulae.find(column.name); found != formulae.end()) {
                texts.push_back(found->second);
                texts.back().unit = column.unit;
                texts.back().meaning = column.meaning;
                formulae.erase(found);
            }
        for (auto& [name, text] : formulae) {
            if (text.meaning.empty()) continue;
            text.is_of_measure_alone = true;
            texts.push_back(text);
        }
        return texts;
    }();
    return known_texts;
}

const MetricText* find_metric(const std::string& name)
{
    const auto found = std::ranges::find(metric_texts(), name, &MetricText::name);
    return found == metric_texts().end() ? nullptr : &*found;
}

}  // namespace experiments
