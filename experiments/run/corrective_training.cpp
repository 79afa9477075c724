#include "experiments/run/corrective_training.hpp"

#include "experiments/process/machine.hpp"
#include "experiments/scene/movements.hpp"
#include "pbs/flesh/quasi_newton.hpp"
#include "pbs/skinning/blend.hpp"

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

namespace experiments {
namespace {

using Eigen::Quaterniond;

constexpr double least_turn_rad = 1e-9;  // below it is rounding
constexpr std::array<double, 3> share_of_joints = {0.12, 0.4, 1.0};
constexpr int most_iterations = 2000;
constexpr double solved_to = 1e-5;

Quaterniond mirrored(const Quaterniond& rotation)
{
    return {rotation.w(), rotation.x(), -rotation.y(), -rotation.z()};
}

// Numbers that every standard library draws alike.
class Random {
public:
    double number(double low, double high)
    {
        return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
    }
    std::size_t index(std::size_t count) { return engine_() % count; }
    Quaterniond rotation(double most_rad)
    {
        pbs::Vec3 axis;
        do
            for (double& coordinate : axis) coordinate = number(-1.0, 1.0);
        while (axis.norm() > 1.0 || axis.norm() < 1e-3);
        return Quaterniond(Eigen::AngleAxisd(number(0.0, most_rad), axis.normalized()));
    }

private:
    std::mt19937 engine_{1};
};

}  // namespace

JointRotations rotations_in(const pbs::Skeleton& skeleton, const std::vector<pbs::Pose>& poses)
{
    JointRotations known(skeleton.bones.size());
    for (const pbs::Pose& pose : poses)
        for (std::size_t b = 0; b < known.size(); ++b) {
            const int parent = skeleton.bones[b].parent;
            if (parent < 0) continue;
            const Quaterniond rotation(Eigen::Matrix3d(pose[parent].linear().transpose() * pose[b].linear()));
            if (rotation.angularDistance(Quaterniond::Identity()) > least_turn_rad)
                known[b].push_back(rotation.normalized());
        }
    return known;
}

JointRotations rotations_of_movements(const pbs::Skeleton& skeleton)
{
    std::vector<pbs::Pose> poses;
    for (const std::string& movement : movements_of(skeleton)) {
        if (movement.find('+') != std::string::npos) continue;
        MotionSpec spec;
        spec.movements = {movement};
        const pbs::Motion motion = through_movements(spec, skeleton, "movements.toml");
        poses.insert(poses.end(), motion.steps.begin(), motion.steps.end());
    }
    JointRotations known = rotations_in(skeleton, poses);
    for (std::size_t b = 0; b < known.size(); ++b) {
        const std::string& name = skeleton.bones[b].name;
        if (!name.ends_with(".L")) continue;
        const int right = pbs::find_bone(skeleton, name.substr(0, name.size() - 2) + ".R");
        if (right < 0) continue;
        for (const Quaterniond& rotation : known[b]) known[right].push_back(mirrored(rotation));
    }
    return known;
}

std::vector<pbs::Pose> drawn_poses(const pbs::Skeleton& skeleton, const JointRotations& known,
                                   const DrawnPoses& options)
{
    Random random;
    std::vector<pbs::Pose> poses;
    for (int p = 0; p < options.count; ++p) {
        std::vector<Quaterniond> turns(skeleton.bones.size(), Quaterniond::Identity());
        const double share = share_of_joints[static_cast<std::size_t>(p) % share_of_joints.size()];
        for (std::size_t b = 0; b < turns.size(); ++b) {
            if (skeleton.bones[b].parent < 0 || random.number(0.0, 1.0) > share) continue;
            if (!known[b].empty()) turns[b] = known[b][random.index(known[b].size())];
            turns[b] = turns[b] * random.rotation(options.further_deg * M_PI / 180.0);
        }
        poses.push_back(pbs::pose_from_joints(skeleton, turns, pbs::Vec3::Zero()));
    }
    return poses;
}

std::vector<pbs::CorrectiveSample> solved_on_linear_elements(const pbs::Character& character,
                                                             const FemOptions& reference,
                                                             const std::vector<pbs::Pose>& poses, double most_s)
{
    if (!reference.has_sample_points())
        throw std::invalid_argument("correctives are learned with bones that springs in capsules hold");
    select_blas_kernels();
    const pbs::BoneSprings springs =
        pbs::bone_springs(character, spring_placement(reference.attachment), spring_options(reference)).springs;
    const pbs::HeldFlesh flesh(character.mesh, springs, static_cast<int>(character.skeleton.bones.size()),
                               {.poisson = reference.poisson});
    pbs::BlendSkinning<double> skinning(character.mesh.rest, flesh.smooth_weights(character.weights));
    pbs::QuasiNewton<double> newton(character.mesh, flesh.energy(), flesh.factor(),
                                    {.iterations = most_iterations, .stop_gradient = solved_to});
    std::vector<pbs::CorrectiveSample> samples;
    const double begin_s = process_cpu_s();
    for (const pbs::Pose& pose : poses) {
        if (process_cpu_s() - begin_s > most_s) break;
        pbs::Positions x, centres;
        skinning.dual_quaternion(pose, x);
        flesh.hold().centres(pose, centres);
        if (newton.minimise(centres, x).converged) samples.push_back({pose, x});
    }
    return samples;
}

}  // namespace experiments
