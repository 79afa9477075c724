#include "pbs/character/capsule_springs.hpp"

namespace pbs {

CapsuleSprings smooth_springs(const Character& character, const SmoothSpringOptions& options)
{
    return capsule_springs(character, options, [&](const BoneCapsule& capsule, const Vec3& point) {
        return smooth_density(capsule, options.kernel, options.ends, point);
    });
}

CapsuleSprings capsule_springs(const Character& character, const SmoothSpringOptions& options,
                               const std::function<double(const BoneCapsule&, const Vec3&)>& density)
{
    CapsuleSprings held{bone_capsules(character, options.core_radius), {}, {}};
    std::vector<double> stiffness;
    for (std::size_t j = 0; j < held.capsules.size(); ++j) {
        const BoneCapsule& capsule = held.capsules[j];
        const Positions points = sample_points(capsule, options.samples);
        const double on_axis = options.spring_factor / (capsule.radius_m * capsule.radius_m);
        const Eigen::Index springs = held.springs.points.rows();
        held.springs.points.conservativeResize(springs + points.rows(), 3);
        held.springs.points.bottomRows(points.rows()) = points;
        held.springs.bone.insert(held.springs.bone.end(), points.rows(), static_cast<int>(j));
        for (const auto& point : points.rowwise()) {
            held.density.push_back(density(capsule, point.transpose()));
            stiffness.push_back(on_axis * held.density.back() * capsule.volume_m3() / static_cast<double>(points.rows()));
        }
    }
    held.springs.stiffness = Eigen::VectorXd::Map(stiffness.data(), static_cast<Eigen::Index>(stiffness.size()));
    return held;
}

}  // namespace pbs
