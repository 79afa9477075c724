// Everything that is measured on one frame of one deformer: the ruler's figures, the errors against the reference, the smallest
// cross-section, the rendered surface's volume.
#pragma once

#include "analysis/cross_section.hpp"
#include "analysis/error_norms.hpp"
#include "analysis/frame_metrics.hpp"
#include "analysis/surface_volume.hpp"
#include "experiments/run/limb_stations.hpp"
#include "experiments/scene/scene.hpp"

#include <optional>

namespace experiments {

struct FrameMeasurement {
    analysis::FrameMetrics metrics;
    double bind_rms_m = 0.0;
    std::optional<analysis::ErrorNorms> errors;
    bool reference_self_intersects = false;
    std::optional<analysis::ErrorNorms> reference_error;  // how far the reference may be from the limit of ever finer tets
    std::optional<double> min_section_pct;
    std::optional<double> surface_volume_change_pct;
    std::optional<double> angle_deg;
    double rotation_deg = 0.0;  // the largest of a bone relative to the root's

    // The error at the joints (over the whole body where nothing is blended) is not above the reference's own: it may be the reference's.
    bool error_below_reference_error() const;
};

// The pose of a frame and what the reference made of it.
struct FrameContext {
    const pbs::Pose* pose = nullptr;
    std::optional<double> angle_deg;
    const pbs::Positions* reference = nullptr;  // null: none, or not finite
    bool reference_self_intersects = false;
    std::optional<analysis::ErrorNorms> reference_error;
};

// What errors of a character are measured on. prescribed: vertices a deformer is told where to be, #V or empty; they are left out.
analysis::ErrorDomain error_domain(const pbs::Character& character, const std::vector<bool>& prescribed);

class FrameMeasurer {
public:
    // prescribed: vertices the reference is told where to be, #V or empty; the errors leave them out.
    FrameMeasurer(const pbs::Character& character, const OutputSpec& output, const std::vector<bool>& prescribed);
    FrameMeasurement measure(const pbs::Positions& positions, const FrameContext& context);
    // In the norms of the errors, which the scene must have asked for.
    analysis::ErrorNorms difference(const pbs::Positions& a, const pbs::Positions& b) const { return error_ruler_.value().measure(a, b); }
    Eigen::VectorXd volume_ratios(const pbs::Positions& positions) const { return ruler_.volume_ratios(positions); }
    bool self_intersects(const pbs::Positions& positions) const;  // asked of the reference of errors alone

private:
    double min_section_pct(const pbs::Positions& positions, const pbs::Pose& pose);

    const pbs::Character& character_;
    analysis::Ruler ruler_;
    std::optional<analysis::ErrorRuler> error_ruler_;
    pbs::Triangles boundary_;  // of the errors
    std::vector<LimbStation> stations_;
    std::vector<analysis::SectionStation> sections_;  // one a station; of the pose being measured
    std::optional<analysis::SurfaceVolume> surface_volume_;
};

}  // namespace experiments
