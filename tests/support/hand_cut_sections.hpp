// The widest section of a bent limb near its joint, computed differently from JointSections: the points at which a plane crosses the edges
// of the skin are ordered by their angle about the bone. This is valid for limbs that are cut once, in an outline that is star-shaped about
// the bone.
//   hand_cut_widest(body, positions, pose).area   // over rest
#pragma once

#include "experiments/studies/artefacts/artefact_case.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace test_support {

struct HandCut {
    double area_m2 = 0.0, largest_radius_m = 0.0;
};

inline std::vector<Eigen::Vector2d> crossings(const pbs::Positions& positions, const pbs::Triangles& skin, const pbs::Vec3& point,
                                              const pbs::Vec3& normal)
{
    const pbs::Vec3 u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
    std::vector<Eigen::Vector2d> found;
    for (const auto triangle : skin.rowwise())
        for (int corner = 0; corner < 3; ++corner) {
            const pbs::Vec3 a = positions.row(triangle(corner)), b = positions.row(triangle((corner + 1) % 3));
            const double below = (a - point).dot(normal), above = (b - point).dot(normal);
            if (!(below < 0.0 && above >= 0.0)) continue;  // each edge only once; in its other triangle it runs from b to a
            const pbs::Vec3 at = (above * a - below * b) / (above - below) - point;
            found.push_back({at.dot(u), at.dot(v)});
        }
    std::sort(found.begin(), found.end(), [](const auto& p, const auto& q) { return std::atan2(p.y(), p.x()) < std::atan2(q.y(), q.x()); });
    return found;
}

inline HandCut hand_cut(const std::vector<Eigen::Vector2d>& outline)
{
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    double length = 0.0;
    HandCut cut;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Eigen::Vector2d &p = outline[i], &q = outline[(i + 1) % outline.size()];
        cut.area_m2 += 0.5 * (p.x() * q.y() - q.x() * p.y());
        moment += 0.5 * (q - p).norm() * (p + q);
        length += (q - p).norm();
    }
    for (const Eigen::Vector2d& p : outline) cut.largest_radius_m = std::max(cut.largest_radius_m, (p - moment / length).norm());
    return cut;
}

// The plane passes through the bone, `offset_m` from the joint; within 3 radii on each side it turns from one bone's direction to the
// other's.
inline HandCut hand_cut(const experiments::ArtefactBody& body, const pbs::Positions& positions, const pbs::Pose& pose, double offset_m)
{
    const experiments::LimbJoint& joint = body.joints.at(0);
    const auto& bones = body.posed.character().skeleton.bones;
    const auto along = [&](int bone) { return pbs::Vec3((bones[bone].tail - bones[bone].head).normalized()); };
    const int carrier = offset_m < 0.0 ? joint.parent : joint.child;
    const double turned = 0.5 + offset_m / (6.0 * joint.radius_m);
    const pbs::Vec3 before = pose[joint.parent].linear() * along(joint.parent), after = pose[joint.child].linear() * along(joint.child);
    const pbs::Vec3 point = pose[carrier] * pbs::Vec3(joint.point + offset_m * along(carrier));
    return hand_cut(crossings(positions, body.posed.boundary(), point, before + turned * (after - before)));
}

// Over all stations, each relative to its own section at rest: the largest area and, at its own station, the largest radius.
struct HandCutWidest {
    double area = 0.0, radius = 0.0;
};

inline HandCutWidest hand_cut_widest(const experiments::ArtefactBody& body, const pbs::Positions& positions, const pbs::Pose& pose)
{
    const pbs::Positions& rest = body.posed.character().mesh.rest;
    const pbs::Pose still(pose.size(), Eigen::Isometry3d::Identity());
    HandCutWidest widest;
    for (const experiments::JointSection& section : body.sections.at(0).measure(rest, still)) {
        const HandCut now = hand_cut(body, positions, pose, section.offset_m), before = hand_cut(body, rest, still, section.offset_m);
        widest.area = std::max(widest.area, now.area_m2 / before.area_m2);
        widest.radius = std::max(widest.radius, now.largest_radius_m / before.largest_radius_m);
    }
    return widest;
}

}  // namespace test_support
