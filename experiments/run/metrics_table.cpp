#include "experiments/run/metrics_table.hpp"

#include <map>

namespace experiments {
namespace {

const std::string volume = "V: signed volume of all tets; V0: at rest", tet_volume = "V_t: signed volume of tet t; V0_t: at rest";
const std::string of_all = "V0: volume of all tets at rest", ratio = "J_t = V_t / V0_t: volume of tet t over its volume at rest";
const std::string positions = "x_i: position of vertex i; xref_i: in the reference", masses = "m_i: rest volume lumped to vertex i";
const std::string free_vertices = "i: vertices that nothing prescribes", blended = "i: vertices that Eq. 2 blends between bones";

using Symbols = std::map<std::string, std::vector<std::string>>;

// Of the formulae, each "name: what it is".
const Symbols& all_symbols()
{
    static const Symbols symbols = {
        {"volume_change_pct", {volume}},
        {"volume_abs_change_pct", {tet_volume, of_all}},
        {"inverted_tets", {tet_volume}},
        {"mean_abs_j_minus_1", {ratio, of_all}},
        {"j_min", {ratio}},
        {"stretch_rms", {"l_e: length of edge e; l0_e: at rest"}},
        {"bind_rms_m",
         {"x_i: position of vertex i", "q_i: where it projects on its bone at rest, carried along by the bone",
          "d_i: distance of the two at rest"}},
        {"error_l2_pct", {positions, masses, free_vertices, "D: diagonal of the bounding box at rest"}},
        {"error_joint_pct", {positions, masses, blended, "d_i: distance of vertex i to its bone at rest"}},
        {"error_linf_m", {positions, free_vertices}},
        {"angle_deg", {"i: the frame; angle_deg, frames: of the scene's [motion]"}},
        {"min_section_pct", {"A_s: area of the cross-section at station s of a limb; A0_s: at rest"}},
        {"surface_volume_change_pct", {"S: volume inside the rendered surface, by the divergence theorem; S0: at rest"}},
    };
    return symbols;
}

}  // namespace

const std::vector<MetricText>& metric_texts()
{
    static const std::vector<MetricText> texts = {
        {"volume_change_pct", "%", "100 (V - V0) / V0", "signed change of the whole volume; the paper's E = V0 - V' is minus this",
         "Sec. 4", "one pass over the tets"},
        {"volume_abs_change_pct", "%", "100 sum_t |V_t - V0_t| / V0", "sum of the absolute changes of each tet: gains do not hide losses",
         "Sec. 4, the other reading", "with volume_change_pct"},
        {"inverted_tets", "", "number of tets t with V_t <= 0", "folded or flattened flesh", "", "with volume_change_pct"},
        {"mean_abs_j_minus_1", "", "sum_t V0_t |J_t - 1| / V0", "mean relative change of volume, weighted by rest volume", "",
         "with volume_change_pct"},
        {"j_min", "", "min_t J_t", "worst tet; negative when inverted", "", "with volume_change_pct"},
        {"stretch_rms", "", "rms_e(l_e / l0_e - 1)", "residual of the stretch constraints", "Eq. 10", "one pass over the edges"},
        {"bind_rms_m", "m", "rms_i(|x_i - q_i| - d_i)", "residual of the bind constraints", "Sec. 3.6", "one pass over the vertices"},
        {"step_ms", "ms", "wall time of the frame's step", "what the deformer cost on this frame, measuring and writing aside", "Table 1",
         ""},
        {"error_l2_pct", "%", "100 sqrt(sum_i m_i |x_i - xref_i|^2 / sum_i m_i) / D", "distance to the reference over free vertices", "",
         "one pass over the vertices"},
        {"error_joint_pct", "%", "100 sqrt(sum_i m_i |x_i - xref_i|^2 / sum_i m_i) / (sum_i m_i d_i / sum_i m_i)",
         "distance to the reference over the vertices Eq. 2 blends: the figure that tells deformers apart", "", "with error_l2_pct"},
        {"error_linf_m", "m", "max_i |x_i - xref_i|", "largest distance to the reference", "", "with error_l2_pct"},
        {"reference_self_intersects", "0/1", "boundary triangles of the reference intersect",
         "such frames are marked, because no deformer has contact", "", "CGAL, some 10 ms a frame"},
        {"reference_error_l2_pct", "%", "grid convergence index of the reference in the norm of error_l2_pct",
         "how far the reference itself may be from the limit of ever finer tets; of error_bar orders, refined, both",
         "P. J. Roache 1994, I. B. Celik et al. 2008", "the reference solved once or twice more; seconds in run.json"},
        {"reference_error_joint_pct", "%", "grid convergence index of the reference in the norm of error_joint_pct",
         "how far the reference itself may be from that limit over the vertices Eq. 2 blends", "", "with reference_error_l2_pct"},
        {"reference_error_linf_m", "m", "grid convergence index of the reference in the norm of error_linf_m",
         "how far the reference itself may be from that limit at the farthest vertex", "", "with reference_error_l2_pct"},
        {"error_below_reference_error", "0/1", "error_joint_pct <= reference_error_joint_pct (l2 where nothing is blended)",
         "such an error may be the reference's own: it tells no deformers apart; empty in the reference's rows", "", ""},
        {"rotation_deg", "deg", "largest angle between a bone's rotation and the root's",
         "how far the pose is from where linear strain is right", "", ""},
        {"fictitious_strain", "", "1 - cos(rotation_deg)", "what linear elasticity takes that rotation for; of the rows of linear FEM", "",
         ""},
        {"outcome", "", "finished, not_finite or not_converged",
         "how the step ended; not_converged: PBS above its stop_residual, or a reference that did not reach its pose and has no error "
         "there",
         "", ""},
        {"angle_deg", "deg", "angle_deg i / (frames - 1)", "angle of a sweep; empty for clips", "", ""},
        {"min_section_pct", "%", "100 min_s A_s / A0_s",
         "smallest cross-section of a limb over its rest area: the candy wrapper in one number", "Fig. 3, 8",
         "plane cuts of the limbs' tets"},
        {"surface_volume_change_pct", "%", "100 (S - S0) / S0", "volume inside the rendered surface that the tets carry", "Sec. 1",
         "one pass over the surface"},
    };
    return texts;
}

std::vector<std::string> symbols_of(const MetricText& metric)
{
    const auto found = all_symbols().find(metric.name);
    return found == all_symbols().end() ? std::vector<std::string>{} : found->second;
}

}  // namespace experiments
