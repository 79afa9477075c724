// Deformers that go to each frame of a far motion in steps from rest, instead of beginning it at a blend of its pose.
// The last frame is no better beginning: what the iterations leave of one frame would add up over the motion.
#include "experiments/deformers/deformer_kind.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/blend.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace experiments {
namespace {

constexpr double far_turn_deg = 90.0;      // of a joint in the first pose: twice what a step may turn
constexpr double most_inside_out = 5e-4;   // of the tets, in the first frame
constexpr double largest_turn_deg = 45.0;  // of a bone in a step, as for the reference

// The largest angle of a bone against its parent. A body that turns as a whole is not far from its bind pose.
double largest_joint_turn_deg(const pbs::Skeleton& skeleton, const pbs::Pose& pose)
{
    double largest = 0.0;
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const int parent = skeleton.bones[j].parent;
        if (parent < 0) continue;
        const Eigen::Quaterniond own(pose[j].linear()), other(pose[static_cast<std::size_t>(parent)].linear());
        largest = std::max(largest, own.angularDistance(other));
    }
    return largest * 180.0 / std::numbers::pi;
}

class FollowingDeformer : public WrappingDeformer {
public:
    using WrappingDeformer::WrappingDeformer;

    void reset(const pbs::Character& character) override
    {
        character_ = &character;
        follows_ = decides_ = has_start_ = false;
        wrapped().reset(character);
    }
    void foresee(const std::vector<pbs::Pose>& poses) override
    {
        const bool may_follow = character_->artist && !poses.empty() && !wrapped().has_memory();
        follows_ = may_follow && largest_joint_turn_deg(character_->skeleton, poses.front()) > far_turn_deg;
        decides_ = may_follow && !follows_;
        if (!follows_) wrapped().foresee(poses);
    }
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override
    {
        const bool has_start = std::exchange(has_start_, false);
        if (follows_ && !has_start) return follow(pose, dt_s);
        const pbs::StepSummary summary = wrapped().advance(pose, dt_s);
        if (!std::exchange(decides_, false) || has_start || !keeps_inside_out()) return summary;
        follows_ = true;
        return follow(pose, dt_s);
    }
    void start_from(const pbs::Positions& shape) override
    {
        has_start_ = true;
        wrapped().start_from(shape);
    }
    nlohmann::json record() const override
    {
        nlohmann::json record = wrapped().record();
        if (follows_) record["follows_from_rest"] = true;
        return record;
    }

private:
    // Whether tets stay inside out, such as those of thin fins, which the blend of the first pose turns over.
    bool keeps_inside_out() const
    {
        const Eigen::VectorXd volumes_m3 = pbs::tet_volumes(wrapped().positions(), character_->mesh.tets);
        return static_cast<double>((volumes_m3.array() <= 0.0).count()) >
               most_inside_out * static_cast<double>(volumes_m3.size());
    }
    pbs::StepSummary follow(const pbs::Pose& pose, double dt_s)
    {
        const pbs::Stopwatch stopwatch;
        pbs::Pose reached(pose.size(), Eigen::Isometry3d::Identity());
        pbs::Positions carried, last = character_->mesh.rest;
        const pbs::PosePath way(character_->skeleton, reached, pose);
        const int steps = std::max(1, static_cast<int>(std::ceil(way.largest_turn_deg() / largest_turn_deg)));
        pbs::FrameStep all_steps;
        pbs::StepSummary sum;
        for (int step = 1; step <= steps; ++step) {
            const pbs::Pose next = way.at(static_cast<double>(step) / steps);
            pbs::Pose moved = next;  // the motion of each bone
            for (std::size_t j = 0; j < next.size(); ++j) moved[j] = next[j] * reached[j].inverse();
            pbs::dual_quaternion_skinning(last, character_->weights, moved, carried);
            wrapped().start_from(carried);
            all_steps.add(wrapped().advance(next, dt_s), static_cast<std::size_t>(step));
            sum.iterations += all_steps.summary().iterations;
            sum.work += all_steps.summary().work;
            last = wrapped().positions();
            reached = next;
        }
        pbs::StepSummary summary = all_steps.summary();
        summary.iterations = sum.iterations;
        summary.work = sum.work;
        summary.seconds = stopwatch.seconds();
        return summary;
    }

    const pbs::Character* character_ = nullptr;
    bool follows_ = false, decides_ = false, has_start_ = false;
};

}  // namespace

std::unique_ptr<Deformer> following(std::unique_ptr<Deformer> deformer)
{
    return std::make_unique<FollowingDeformer>(std::move(deformer));
}

}  // namespace experiments
