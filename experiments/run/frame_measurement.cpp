#include "experiments/run/frame_measurement.hpp"

#include "experiments/characters/model_character.hpp"
#include "pbs/geometry/extent.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

namespace experiments {
namespace {

constexpr double limb_slenderness = 3.0;
constexpr double own_flesh = 0.9;         // of the area that the plane cuts nearby
constexpr double nearby_distances = 2.0;  // in mean distances of the bone's vertices
constexpr int stations_per_limb = 5;

pbs::Vec3 direction(const pbs::Bone& bone)
{
    return (bone.tail - bone.head).normalized();
}

// Mean distance at rest of the vertices that are bound to each bone [m], #bones; zero for a bone without vertices.
std::vector<double> mean_distances(const pbs::Character& character)
{
    std::vector<double> distance(character.skeleton.bones.size(), 0.0);
    std::vector<int> count(distance.size(), 0);
    for (std::size_t v = 0; v < character.binding.bone.size(); ++v) {
        distance[character.binding.bone[v]] += character.binding.distance(v);
        ++count[character.binding.bone[v]];
    }
    for (std::size_t b = 0; b < distance.size(); ++b) distance[b] = count[b] > 0 ? distance[b] / count[b] : 0.0;
    return distance;
}

bool is_limb(const pbs::Bone& bone, double mean_distance)
{
    return mean_distance > 0.0 && (bone.tail - bone.head).norm() > limb_slenderness * mean_distance;
}

bool in_one_line(const pbs::Skeleton& skeleton, int parent, int child)
{
    const auto meeting = pbs::bones_meeting(skeleton, parent, pbs::BoneEnd::tail);
    return std::count(meeting.begin(), meeting.end(), child) > 0 &&
           direction(skeleton.bones[parent]).dot(direction(skeleton.bones[child])) > 0.0;
}

// The bones themselves and the next limbs in line.
std::set<int> along_limb(const pbs::Skeleton& skeleton, const std::vector<int>& carriers)
{
    std::set<int> bones(carriers.begin(), carriers.end());
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
        const int parent = skeleton.bones[b].parent;
        if (parent < 0 || !in_one_line(skeleton, parent, static_cast<int>(b))) continue;
        const bool parent_in = std::count(carriers.begin(), carriers.end(), parent) > 0;
        const bool child_in = std::count(carriers.begin(), carriers.end(), static_cast<int>(b)) > 0;
        if (parent_in) bones.insert(static_cast<int>(b));
        if (child_in) bones.insert(parent);
    }
    return bones;
}

// The tets with all vertices chosen.
std::vector<int> tets_within(const pbs::Tets& tets, const std::vector<char>& chosen)
{
    std::vector<int> within;
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
        const auto corners = tets.row(t);
        if (std::all_of(corners.begin(), corners.end(), [&](int v) { return chosen[v]; }))
            within.push_back(static_cast<int>(t));
    }
    return within;
}

std::vector<int> tets_of(const pbs::Character& character, const std::set<int>& bones)
{
    std::vector<char> chosen(character.binding.bone.size());
    for (std::size_t v = 0; v < chosen.size(); ++v) chosen[v] = bones.count(character.binding.bone[v]) > 0;
    return tets_within(character.mesh.tets, chosen);
}

std::vector<int> tets_near(const pbs::TetMesh& mesh, const pbs::Vec3& point, double radius)
{
    std::vector<char> chosen(mesh.rest.rows());
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v)
        chosen[v] = (mesh.rest.row(v).transpose() - point).norm() < radius;
    return tets_within(mesh.tets, chosen);
}

bool has_its_own_flesh(const pbs::Character& character, const LimbStation& station, double mean_distance)
{
    const analysis::Plane plane{station.point, station.normal};
    const auto area = [&](const std::vector<int>& tets) {
        return analysis::cross_section_area(character.mesh.rest, character.mesh.tets, tets, plane);
    };
    const double own = area(station.tets);
    return own > 0.0 &&
           own >= own_flesh * area(tets_near(character.mesh, station.point, nearby_distances * mean_distance));
}

LimbStation station_at(const pbs::Character& character, std::string name, const pbs::Vec3& point,
                       const pbs::Vec3& normal, std::vector<int> carriers)
{
    std::vector<int> tets = tets_of(character, along_limb(character.skeleton, carriers));
    return {std::move(name), point, normal.normalized(), std::move(carriers), std::move(tets)};
}

}  // namespace

std::vector<LimbStation> limb_stations(const pbs::Character& character)
{
    const auto& bones = character.skeleton.bones;
    const std::vector<double> distances = mean_distances(character);
    std::vector<LimbStation> stations;
    const auto add = [&](LimbStation station, double mean_distance) {
        if (has_its_own_flesh(character, station, mean_distance)) stations.push_back(std::move(station));
    };
    for (int b = 0; b < static_cast<int>(bones.size()); ++b) {
        if (!is_limb(bones[b], distances[b])) continue;
        for (int i = 1; i <= stations_per_limb; ++i) {
            const double along = i / (stations_per_limb + 1.0);
            const pbs::Vec3 point = bones[b].head + along * (bones[b].tail - bones[b].head);
            add(station_at(character, fmt::format("{} {:.2f}", bones[b].name, along), point, direction(bones[b]), {b}),
                distances[b]);
        }
        const int parent = bones[b].parent;
        if (parent < 0 || !is_limb(bones[parent], distances[parent]) || !in_one_line(character.skeleton, parent, b))
            continue;
        const pbs::Vec3 normal = direction(bones[parent]) + direction(bones[b]);
        add(station_at(character, bones[parent].name + "|" + bones[b].name, bones[b].head, normal, {parent, b}),
            distances[b]);
    }
    return stations;
}

pbs::Vec3 posed_point(const LimbStation& station, const pbs::Pose& pose)
{
    pbs::Vec3 sum = pbs::Vec3::Zero();
    for (const int bone : station.carriers) sum += pose[bone] * station.point;
    return sum / static_cast<double>(station.carriers.size());
}

pbs::Vec3 posed_normal(const LimbStation& station, const pbs::Pose& pose)
{
    pbs::Vec3 sum = pbs::Vec3::Zero();
    for (const int bone : station.carriers) sum += pose[bone].linear() * station.normal;
    return sum.norm() > 0.0 ? pbs::Vec3(sum.normalized())
                            : pbs::Vec3(pose[station.carriers.front()].linear() * station.normal);
}

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
    return std::isnan(errors->joint_pct) ? errors->l2_pct <= reference_error->l2_pct
                                         : errors->joint_pct <= reference_error->joint_pct;
}

FrameMeasurer::FrameMeasurer(const pbs::Character& character, const OutputSpec& output,
                             const std::vector<bool>& prescribed)
    : character_(character),
      metrics_(character.mesh.rest, character.mesh.tets),
      skin_(pbs::boundary_of(character.mesh.tets))
{
    if (output.errors) {
        error_metrics_.emplace(error_domain(character, prescribed));
        skin_error_metrics_.emplace(character.mesh.rest, character.mesh.tets);
        masked_.assign(character.mesh.rest.rows(), false);
    }
    if (output.sections) stations_ = limb_stations(character);
    for (const LimbStation& station : stations_) {
        const analysis::Plane rest{station.point, station.normal};
        sections_.push_back(
            {rest, rest, station.tets,
             analysis::cross_section_area(character.mesh.rest, character.mesh.tets, station.tets, rest)});
    }
    if (output.surface && character.surface)
        surface_volume_ = analysis::surface_volume_of(
            pbs::embedded_positions(*character.surface, character.mesh.rest, character.mesh.tets),
            character.surface->triangles);
}

FrameMeasurement FrameMeasurer::measure(const pbs::Positions& positions, const FrameContext& context)
{
    FrameMeasurement measured;
    measured.metrics = metrics_.measure(positions);
    measured.bind_rms_m = analysis::bind_rms(positions, pbs::posed_bind_points(character_.binding, *context.pose),
                                             character_.binding.distance);
    measured.angle_deg = context.angle_deg;
    const Eigen::Quaterniond root(context.pose->front().linear());
    double rotation_rad = 0.0;
    for (const auto& bone : *context.pose)
        rotation_rad = std::max(rotation_rad, root.angularDistance(Eigen::Quaterniond(bone.linear())));
    measured.rotation_deg = rotation_rad * 180.0 / std::numbers::pi;
    if (error_metrics_ && context.reference) {
        measured.errors = difference(positions, *context.reference);
        measured.errors_on_whole_body = error_metrics_->measure(positions, *context.reference);
        measured.skin = skin_error_metrics_->measure(positions, *context.reference, masked_);
        measured.masked_share_pct = error_metrics_->share_pct(masked_);
        measured.reference_error = context.reference_error;
    }
    if (!positions.allFinite()) return measured;
    if (!stations_.empty()) measured.min_section_pct = min_section_pct(positions, *context.pose);
    if (surface_volume_)
        measured.surface_volume_change_pct =
            surface_volume_->change_pct(pbs::surface_positions(character_, positions, *context.pose));
    return measured;
}

double FrameMeasurer::leave_out(const std::vector<CreaseTip>& tips)
{
    masked_ = near_tips(tips, character_.mesh.rest);
    return error_metrics_.value().share_pct(masked_);
}

std::vector<int> FrameMeasurer::contact_depths_um(const pbs::Positions& positions)
{
    const pbs::TetMesh& mesh = character_.mesh;
    if (!contact_) {
        std::vector<int> rows(mesh.rest.rows());
        std::iota(rows.begin(), rows.end(), 0);
        contact_.emplace(mesh, rows, 3);
    }
    // Both skins are moved outwards by half of the distance at which they touch.
    const double touching_m = 1e-3 * pbs::diagonal_m(mesh.rest);
    pbs::Positions normals = pbs::Positions::Zero(positions.rows(), 3);
    for (const auto corners : skin_.rowwise()) {
        const pbs::Vec3 a = positions.row(corners(0)), b = positions.row(corners(1)), c = positions.row(corners(2));
        for (const int v : corners) normals.row(v) += (b - a).cross(c - a);
    }
    pbs::Positions moved = positions;
    for (Eigen::Index v = 0; v < moved.rows(); ++v)
        moved.row(v) += 0.5 * touching_m * normals.row(v).stableNormalized();
    std::vector<int> depths_um(positions.rows(), 0);
    contact_->forget();
    contact_->find(moved.data());
    for (const pbs::DepthConstraint<double>& constraint : contact_->constraints()) {
        const double depth_m = -value(constraint, contact_->points(constraint, moved.data())) - touching_m;
        int& depth_um = depths_um[constraint.vertex[0]];
        depth_um = depth_m > 0.0   ? std::max(depth_um, static_cast<int>(std::min(std::ceil(1e6 * depth_m), 1e9)))
                   : depth_um == 0 ? -1
                                   : depth_um;
    }
    return depths_um;
}

double FrameMeasurer::min_section_pct(const pbs::Positions& positions, const pbs::Pose& pose)
{
    for (std::size_t i = 0; i < stations_.size(); ++i)
        sections_[i].posed = {posed_point(stations_[i], pose), posed_normal(stations_[i], pose)};
    return 100.0 *
           analysis::section_extremes(character_.mesh.rest, positions, character_.mesh.tets, sections_).smallest_ratio;
}

}  // namespace experiments
