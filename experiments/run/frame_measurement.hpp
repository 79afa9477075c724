// Everything that is measured on one frame of one deformer: the metrics of the tets, the errors against the reference, the smallest
// cross-section, and the volume of the rendered surface.
#pragma once

#include "analysis/metrics/cross_section.hpp"
#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/character/overlap_and_jiggle.hpp"

#include <optional>

namespace experiments {

struct FrameMeasurement {
    analysis::FrameMetrics metrics;
    double bind_rms_m = 0.0;
    std::optional<analysis::ErrorNorms> errors;                // outside the part of the body where the reference overlaps itself
    std::optional<analysis::ErrorNorms> errors_on_whole_body;  // with it
    std::optional<double> masked_share_pct;                    // share of the volume of that part
    std::optional<analysis::ErrorNorms> reference_error;       // bound of the reference's distance from the limit of ever finer tets
    std::optional<double> min_section_pct;
    std::optional<double> surface_volume_change_pct;
    std::optional<double> angle_deg;
    double rotation_deg = 0.0;  // the largest of all bones, relative to the root

    // True if the error at the joints (over the whole body if nothing is blended) is not above that of the reference, and may come from it.
    bool error_below_reference_error() const;
};

// The pose of a frame, and the reference's positions in it.
struct FrameContext {
    const pbs::Pose* pose = nullptr;
    std::optional<double> angle_deg;
    const pbs::Positions* reference = nullptr;  // null: there is no reference, or it is not finite
    std::optional<analysis::ErrorNorms> reference_error;
};

// The vertices that errors are measured on. prescribed: vertices whose positions a deformer is given, #V or empty; they are left out.
analysis::ErrorDomain error_domain(const pbs::Character& character, const std::vector<bool>& prescribed);

class FrameMeasurer {
public:
    // prescribed: as in error_domain.
    FrameMeasurer(const pbs::Character& character, const OutputSpec& output, const std::vector<bool>& prescribed);
    FrameMeasurement measure(const pbs::Positions& positions, const FrameContext& context);
    // Finds the part of the body where the reference overlaps itself in the coming frame, and the vertices of the tets that it inverts by
    // their vertices alone; errors and differences leave them out. The share of their volume [%]. The scene must have asked for errors.
    double leave_out_overlap(const pbs::Positions& reference);
    // The difference in the norms of the errors. The scene must have asked for errors.
    analysis::ErrorNorms difference(const pbs::Positions& a, const pbs::Positions& b) const
    {
        return error_metrics_.value().measure(a, b, masked_);
    }
    bool measures_surface_volume() const { return surface_volume_.has_value(); }
    Eigen::VectorXd volume_ratios(const pbs::Positions& positions) const { return metrics_.volume_ratios(positions); }

private:
    double min_section_pct(const pbs::Positions& positions, const pbs::Pose& pose);

    const pbs::Character& character_;
    analysis::MeshMetrics metrics_;
    std::optional<analysis::ErrorMetrics> error_metrics_;
    std::optional<pbs::OverlapMask> overlap_;  // if errors are measured
    std::vector<bool> masked_;                 // in this frame, #V
    std::vector<LimbStation> stations_;
    std::vector<analysis::SectionStation> sections_;  // one per station, in the pose that is being measured
    std::optional<analysis::SurfaceVolume> surface_volume_;  // if the surface is closed
};

}  // namespace experiments
