// Everything that is measured on one frame of one deformer: the metrics of the tets, the errors against the reference,
// the smallest cross-section, and the volume of the rendered surface.
//   FrameMeasurer measurer(character, scene.output, prescribed);
//   const FrameMeasurement measured = measurer.measure(positions, {.pose = &pose, .reference = &reference});
#pragma once

#include "analysis/metrics/cross_section.hpp"
#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/metrics/skin_error.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/meshes/meshing.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/contact/self_contact.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/step_summary.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The planes that cut limbs to find their smallest cross-section: across bones that flesh surrounds like a sleeve, and
// across the joints between such bones.

// A plane in the rest pose, and the bones that move it: its posed point and normal are the means over these bones.
struct LimbStation {
    std::string name;           // e.g. "forearm 0.33", "upper|forearm"
    pbs::Vec3 point, normal;    // rest [m], unit
    std::vector<int> carriers;  // one bone, or the two that meet at the joint
    std::vector<int> tets;      // tets of these bones and their neighbours along the limb
};

// A bone is a limb if it is longer than 3 times the mean distance of its vertices. Stations are at 1/6, 2/6 ... 5/6 of
// each limb, and at each joint between two limbs that meet at an angle below 90 degrees. A station is left out if the
// limb shares its flesh with other bones, as in the trunk: less than nine tenths of the area that the plane cuts nearby
// belongs to the limb.
std::vector<LimbStation> limb_stations(const pbs::Character& character);

pbs::Vec3 posed_point(const LimbStation& station, const pbs::Pose& pose);
pbs::Vec3 posed_normal(const LimbStation& station, const pbs::Pose& pose);

struct FrameMeasurement {
    analysis::FrameMetrics metrics;
    double bind_rms_m = 0.0;
    std::optional<analysis::ErrorNorms> errors;                // outside the tips of the reference's creases
    std::optional<analysis::ErrorNorms> errors_on_whole_body;  // with them
    std::optional<analysis::SkinError> skin;                   // outside these tips
    std::optional<double> masked_share_pct;                    // share of the volume at these tips
    // bound of the reference's distance from the limit of ever finer tets
    std::optional<analysis::ErrorNorms> reference_error;
    std::optional<double> min_section_pct;
    std::optional<double> surface_volume_change_pct;
    std::optional<double> angle_deg;
    double rotation_deg = 0.0;  // the largest of all bones, relative to the root

    // True if the error at the joints (over the whole body if nothing is blended) is not above that of the reference,
    // and may come from it.
    bool error_below_reference_error() const;
};

// The pose of a frame, and the reference's positions in it.
struct FrameContext {
    const pbs::Pose* pose = nullptr;
    std::optional<double> angle_deg = {};
    const pbs::Positions* reference = nullptr;  // null: there is no reference, or it is not finite
    std::optional<analysis::ErrorNorms> reference_error = {};
};

// The vertices that errors are measured on. prescribed: vertices whose positions a deformer is given, #V or empty; they
// are left out.
analysis::ErrorDomain error_domain(const pbs::Character& character, const std::vector<bool>& prescribed);

class FrameMeasurer {
public:
    // prescribed: as in error_domain.
    FrameMeasurer(const pbs::Character& character, const OutputSpec& output, const std::vector<bool>& prescribed);
    FrameMeasurement measure(const pbs::Positions& positions, const FrameContext& context);
    // Leaves the vertices near these tips out of the errors and differences of the coming frame, and returns the share
    // of their volume [%]. The scene must have asked for errors.
    double leave_out(const std::vector<CreaseTip>& tips);
    // Whether the skin passes through itself, which that of an equilibrium with contact does not.
    bool overlaps(const pbs::Positions& positions) const { return pbs::self_intersects(positions, skin_); }
    // The difference in the norms of the errors. The scene must have asked for errors.
    analysis::ErrorNorms difference(const pbs::Positions& a, const pbs::Positions& b) const
    {
        return error_metrics_.value().measure(a, b, masked_);
    }
    bool measures_surface_volume() const { return surface_volume_.has_value(); }
    Eigen::VectorXd volume_ratios(const pbs::Positions& positions) const { return metrics_.volume_ratios(positions); }
    // The depth of each skin vertex in flesh of another part of the body [um], #V. It is -1 where the two only touch
    // (closer than a thousandth of the body's diagonal at rest), and 0 elsewhere.
    std::vector<int> contact_depths_um(const pbs::Positions& positions);

private:
    double min_section_pct(const pbs::Positions& positions, const pbs::Pose& pose);

    const pbs::Character& character_;
    analysis::MeshMetrics metrics_;
    std::optional<analysis::ErrorMetrics> error_metrics_;
    std::optional<analysis::SkinErrorMetrics> skin_error_metrics_;
    pbs::Triangles skin_;
    std::vector<bool> masked_;                         // in this frame, #V
    std::optional<pbs::SelfContact<double>> contact_;  // from the first frame whose contact is measured
    std::vector<LimbStation> stations_;
    std::vector<analysis::SectionStation> sections_;         // one per station, in the pose that is being measured
    std::optional<analysis::SurfaceVolume> surface_volume_;  // if the surface is closed
};

}  // namespace experiments
