#include "experiments/artefacts/limb_joints.hpp"

#include "experiments/limb_stations.hpp"
#include "pbs/geometry/topology.hpp"

#include <cmath>

namespace experiments {
namespace {

constexpr double cosine_of_60_deg = 0.5;
constexpr double straight_rad = 0.02;  // bones nearer to one line have no plane of their own

pbs::Vec3 along(const pbs::Bone& bone)
{
    return bone.tail - bone.head;
}

// A foot does not: planes across the ankle cut it lengthwise.
bool passes_through(const pbs::Bone& parent, const pbs::Bone& child)
{
    return along(parent).normalized().dot(along(child).normalized()) > cosine_of_60_deg;
}

double limb_radius(const pbs::Character& character, int parent, int child)
{
    const std::vector<bool> skin = pbs::boundary_vertices(character.mesh.tets, character.mesh.rest.rows());
    double sum_m = 0.0;
    int count = 0;
    for (std::size_t v = 0; v < character.binding.bone.size(); ++v) {
        if (!skin[v] || (character.binding.bone[v] != parent && character.binding.bone[v] != child)) continue;
        sum_m += character.binding.distance(v);
        ++count;
    }
    return sum_m / count;
}

}  // namespace

std::vector<LimbJoint> limb_joints(const pbs::Character& character)
{
    std::vector<LimbJoint> joints;
    for (const LimbStation& station : limb_stations(character)) {
        if (station.carriers.size() != 2 || station.point.x() < -1e-9) continue;
        const int parent = station.carriers[0], child = station.carriers[1];
        if (!passes_through(character.skeleton.bones[parent], character.skeleton.bones[child])) continue;
        joints.push_back({station.name, parent, child, station.point, limb_radius(character, parent, child),
                          0.5 * along(character.skeleton.bones[parent]).norm(), 0.5 * along(character.skeleton.bones[child]).norm()});
    }
    return joints;
}

pbs::Vec3 twist_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint)
{
    return along(skeleton.bones[joint.child]).normalized();
}

pbs::Vec3 hinge_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint)
{
    const pbs::Vec3 parent = along(skeleton.bones[joint.parent]).normalized(), child = twist_axis(skeleton, joint);
    const pbs::Vec3 across = parent.cross(child);
    if (across.norm() > straight_rad) return across.normalized();
    const pbs::Vec3 z = pbs::Vec3::UnitZ() - child.z() * child;
    return z.norm() > straight_rad ? pbs::Vec3(z.normalized()) : pbs::Vec3(pbs::Vec3::UnitX());
}

std::vector<bool> near_joint(const pbs::Character& character, const LimbJoint& joint)
{
    std::vector<bool> near(character.binding.bone.size());
    for (std::size_t v = 0; v < near.size(); ++v) {
        const int bone = character.binding.bone[v];
        const double parameter = character.binding.parameter(v);
        near[v] = (bone == joint.child && parameter <= 1.0 / 3.0) || (bone == joint.parent && parameter >= 2.0 / 3.0);
    }
    return near;
}

}  // namespace experiments
