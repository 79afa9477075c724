#include "experiments/run/frame_measurement.hpp"

#include <cmath>
#include <numbers>

namespace experiments {
namespace {

// The largest rotation [deg] of a bone relative to the root's.
double largest_rotation_deg(const pbs::Pose& pose)
{
    const Eigen::Quaterniond root(pose.front().linear());
    double largest = 0.0;
    for (const auto& bone : pose) largest = std::max(largest, root.angularDistance(Eigen::Quaterniond(bone.linear())));
    return largest * 180.0 / std::numbers::pi;
}

}  // namespace

analysis::ErrorDomain error_domain(const pbs::Character& character, const std::vector<bool>& prescribed)
{
    analysis::ErrorDomain domain{character.mesh.rest, character.mesh.tets, prescribed, {}, character.binding.distance};
    for (std::size_t v = 0; v < character.blended.size(); ++v)
        if (character.blended[v]) domain.blended.push_back(static_cast<int>(v));
    return domain;
}

bool FrameMeasurement::error_below_reference_error() const
{
    if (!errors || !reference_error) return false;
    return std::isnan(errors->joint_pct) ? errors->l2_pct <= reference_error->l2_pct : errors->joint_pct <= reference_error->joint_pct;
}

FrameMeasurer::FrameMeasurer(const pbs::Character& character, const OutputSpec& output, const std::vector<bool>& prescribed)
    : character_(character), metrics_(character.mesh.rest, character.mesh.tets)
{
    if (output.errors) {
        error_metrics_.emplace(error_domain(character, prescribed));
        overlap_.emplace(character);
        masked_.assign(character.mesh.rest.rows(), false);
    }
    if (output.sections) stations_ = limb_stations(character);
    for (const LimbStation& station : stations_) {
        const analysis::Plane rest{station.point, station.normal};
        sections_.push_back(
            {rest, rest, station.tets, analysis::cross_section_area(character.mesh.rest, character.mesh.tets, station.tets, rest)});
    }
    if (output.surface && character.surface)
        surface_volume_ = analysis::surface_volume_of(
            pbs::embedded_positions(*character.surface, character.mesh.rest, character.mesh.tets), character.surface->triangles);
}

FrameMeasurement FrameMeasurer::measure(const pbs::Positions& positions, const FrameContext& context)
{
    FrameMeasurement measured;
    measured.metrics = metrics_.measure(positions);
    measured.bind_rms_m =
        analysis::bind_rms(positions, pbs::posed_bind_points(character_.binding, *context.pose), character_.binding.distance);
    measured.angle_deg = context.angle_deg;
    measured.rotation_deg = largest_rotation_deg(*context.pose);
    if (error_metrics_ && context.reference) {
        measured.errors = difference(positions, *context.reference);
        measured.errors_on_whole_body = error_metrics_->measure(positions, *context.reference);
        measured.masked_share_pct = error_metrics_->share_pct(masked_);
        measured.reference_error = context.reference_error;
    }
    if (!positions.allFinite()) return measured;
    if (!stations_.empty()) measured.min_section_pct = min_section_pct(positions, *context.pose);
    if (surface_volume_)
        measured.surface_volume_change_pct =
            surface_volume_->change_pct(pbs::embedded_positions(*character_.surface, positions, character_.mesh.tets));
    return measured;
}

double FrameMeasurer::leave_out_overlap(const pbs::Positions& reference)
{
    masked_ = overlap_.value().of(reference);
    const Eigen::VectorXd ratios = metrics_.volume_ratios(reference);
    for (Eigen::Index t = 0; t < ratios.size(); ++t)
        if (!(ratios(t) > 0.0))
            for (const int v : character_.mesh.tets.row(t)) masked_[v] = true;
    return error_metrics_->share_pct(masked_);
}

double FrameMeasurer::min_section_pct(const pbs::Positions& positions, const pbs::Pose& pose)
{
    for (std::size_t i = 0; i < stations_.size(); ++i)
        sections_[i].posed = {posed_point(stations_[i], pose), posed_normal(stations_[i], pose)};
    return 100.0 * analysis::section_extremes(character_.mesh.rest, positions, character_.mesh.tets, sections_).smallest_ratio;
}

}  // namespace experiments
