#include "experiments/studies/artefacts/joint_sections.hpp"

#include "analysis/metrics/cross_section.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace experiments {
namespace {

constexpr double reach_radii = 2.0, fan_radii = 3.0;
constexpr int stations_per_radius = 5;

pbs::Vec3 direction(const pbs::Skeleton& skeleton, int bone, const pbs::Pose& pose)
{
    return pose[bone].linear() * (skeleton.bones[bone].tail - skeleton.bones[bone].head).normalized();
}

std::vector<double> offsets_of(const LimbJoint& joint)
{
    const double spacing_m = joint.radius_m / stations_per_radius;
    const int before = static_cast<int>(std::min(reach_radii * joint.radius_m, joint.reach_parent_m) / spacing_m);
    const int after = static_cast<int>(std::min(reach_radii * joint.radius_m, joint.reach_child_m) / spacing_m);
    std::vector<double> offsets_m;
    for (int i = -before; i <= after; ++i) offsets_m.push_back(i * spacing_m);
    return offsets_m;
}

bool is_below(const pbs::Skeleton& skeleton, int bone, int ancestor)
{
    while (bone >= 0 && bone != ancestor) bone = skeleton.bones[bone].parent;
    return bone == ancestor;
}

std::vector<bool> vertices_on_limb(const pbs::Character& character, const LimbJoint& joint)
{
    std::vector<bool> on_limb;
    for (const int bone : character.binding.bone) on_limb.push_back(is_below(character.skeleton, bone, joint.parent));
    return on_limb;
}

double share(double now, double rest)
{
    return rest > 0.0 ? now / rest : 1.0;
}

}  // namespace

SectionExtremesOverRest extremes_of(const JointProfile& profile)
{
    SectionExtremesOverRest extremes;
    if (profile.empty()) return extremes;
    const auto range = [&](double JointSection::*size) {
        const auto [least, most] =
            std::minmax_element(profile.begin(), profile.end(), [&](const auto& a, const auto& b) { return a.*size < b.*size; });
        return std::pair{(*least).*size, (*most).*size};
    };
    extremes.smallest_radius = range(&JointSection::smallest_radius).first;
    const auto widest =
        std::max_element(profile.begin(), profile.end(), [](const auto& a, const auto& b) { return a.largest_radius < b.largest_radius; });
    extremes.largest_radius = widest->largest_radius;
    extremes.limb_share_of_widest = widest->limb_share;
    std::tie(extremes.smallest_area, extremes.largest_area) = range(&JointSection::area);
    return extremes;
}

JointSections::JointSections(const pbs::Character& character, const LimbJoint& joint)
    : skeleton_(character.skeleton),
      joint_(joint),
      skin_(pbs::boundary_of(character.mesh.tets)),
      on_limb_(vertices_on_limb(character, joint)),
      offsets_m_(offsets_of(joint))
{
    const pbs::Pose still(skeleton_.bones.size(), Eigen::Isometry3d::Identity());
    rest_ = cuts(character.mesh.rest, still);
}

double JointSections::bend_deg(const pbs::Pose& pose) const
{
    const pbs::Vec3 before = direction(skeleton_, joint_.parent, pose), after = direction(skeleton_, joint_.child, pose);
    return std::atan2(before.cross(after).norm(), before.dot(after)) * 180.0 / std::numbers::pi;
}

std::vector<pbs::CuttingPlane> JointSections::planes(const pbs::Pose& pose) const
{
    const pbs::Pose still(pose.size(), Eigen::Isometry3d::Identity());
    const pbs::Vec3 before = direction(skeleton_, joint_.parent, pose), after = direction(skeleton_, joint_.child, pose);
    std::vector<pbs::CuttingPlane> planes;
    for (const double offset_m : offsets_m_) {
        const int bone = offset_m < 0.0 ? joint_.parent : joint_.child;
        const double turned = std::clamp(0.5 + 0.5 * offset_m / (fan_radii * joint_.radius_m), 0.0, 1.0);
        const pbs::Vec3 at_rest = joint_.point + offset_m * direction(skeleton_, bone, still);
        const pbs::Vec3 normal = (1.0 - turned) * before + turned * after;
        planes.push_back({pose[bone] * at_rest, normal.norm() > 0.0 ? normal : after});
    }
    return planes;
}

std::vector<JointSections::Cut> JointSections::cuts(const pbs::Positions& positions, const pbs::Pose& pose) const
{
    const std::vector<pbs::CuttingPlane> planes = this->planes(pose);
    const auto sections = pbs::section_outlines(positions, skin_, planes);
    std::vector<Cut> cuts;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        Cut cut{.outlines = static_cast<int>(sections[i].size())};
        const analysis::Plane plane = {planes[i].point, planes[i].normal};
        if (const pbs::Positions* own = analysis::enclosing_outline(sections[i], plane)) {
            cut.size = analysis::outline_size(*own);
            cut.limb_share = analysis::share_of_outline(*own, plane, positions, skin_, on_limb_);
        }
        cuts.push_back(cut);
    }
    return cuts;
}

JointProfile JointSections::measure(const pbs::Positions& positions, const pbs::Pose& pose) const
{
    const std::vector<Cut> now = cuts(positions, pose);
    JointProfile profile;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const analysis::OutlineSize &size = now[i].size, &rest = rest_[i].size;
        profile.push_back({offsets_m_[i], share(size.area_m2, rest.area_m2), share(size.smallest_radius_m, rest.smallest_radius_m),
                           share(size.largest_radius_m, rest.largest_radius_m), now[i].outlines, now[i].limb_share});
    }
    return profile;
}

}  // namespace experiments
