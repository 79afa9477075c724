#include "experiments/metrics_table.hpp"

namespace experiments {

const std::vector<MetricText>& metric_texts()
{
    static const std::vector<MetricText> texts = {
        {"volume_change_pct", "%", "100 (V - V0) / V0", "signed change of the whole volume; the paper's E = V0 - V' is minus this",
         "Sec. 4", "one pass over the tets"},
        {"volume_abs_change_pct", "%", "100 sum_t |V_t - V0_t| / V0", "sum of the absolute changes of each tet: gains do not hide losses",
         "Sec. 4, the other reading", "with the above"},
        {"inverted_tets", "", "number of tets with V_t <= 0", "folded or flattened flesh", "", "with the above"},
        {"mean_abs_j_minus_1", "", "sum_t V0_t |J_t - 1| / V0, J_t = V_t / V0_t", "mean relative change of volume, weighted by rest volume",
         "", "with the above"},
        {"j_min", "", "min_t J_t", "worst tet; negative when inverted", "", "with the above"},
        {"stretch_rms", "", "rms over edges of l / l0 - 1", "residual of the stretch constraints", "Eq. 10", "one pass over the edges"},
        {"bind_rms_m", "m", "rms over vertices of |x_i - q_i| - d_i",
         "residual of the bind constraints; q_i the rest projection carried by the bone", "Sec. 3.6", "one pass over the vertices"},
        {"step_ms", "ms", "wall time of the frame's step", "what the deformer cost on this frame, measuring and writing aside", "Table 1",
         ""},
        {"error_l2_pct", "%", "100 sqrt(sum m_i |x_i - xref_i|^2 / sum m_i) / D",
         "distance to the reference over free vertices; m_i lumped rest volume, D diagonal of the rest bounding box", "",
         "one pass over the vertices"},
        {"error_joint_pct", "%", "100 rms(|x_i - xref_i|) / mean rest distance to the bone, both weighted by m_i",
         "the same over the vertices Eq. 2 blends: the figure that tells deformers apart", "", "with the above"},
        {"error_linf_m", "m", "max |x_i - xref_i| over free vertices", "largest distance to the reference", "", "with the above"},
        {"reference_self_intersects", "0/1", "boundary triangles of the reference intersect",
         "such frames are marked, because no deformer has contact", "", "CGAL, some 10 ms a frame"},
        {"reference_error_l2_pct", "%", "grid convergence index of the reference in the norm of error_l2_pct",
         "how far the reference itself may be from the limit of ever finer tets; of error_bar orders, refined, both",
         "P. J. Roache 1994, I. B. Celik et al. 2008", "the reference solved once or twice more; seconds in run.json"},
        {"reference_error_joint_pct", "%", "the same in the norm of error_joint_pct", "the same over the vertices Eq. 2 blends", "",
         "with the above"},
        {"reference_error_linf_m", "m", "the same in the norm of error_linf_m", "the same at the farthest vertex", "", "with the above"},
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
        {"angle_deg", "deg", "angle_deg * i / (frames - 1)", "angle of a sweep; empty for clips", "", ""},
        {"min_section_pct", "%", "100 min over limb stations of A / A0",
         "smallest cross-section of a limb over its rest area: the candy wrapper in one number", "Fig. 3, 8",
         "plane cuts of the limbs' tets"},
        {"surface_volume_change_pct", "%", "100 (S - S0) / S0, S by the divergence theorem",
         "volume inside the rendered surface that the tets carry", "Sec. 1", "one pass over the surface"},
    };
    return texts;
}

}  // namespace experiments
