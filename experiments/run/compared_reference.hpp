// The reference of a run, as the other deformers are compared with it: in which frames, outside which part of the body,
// with which error of its own, and what makes its frames doubtful.
//   ComparedReference reference(scene, character, runners.front(), cost);
//   reference.advance(pose, dt_s);                              // whenever the runner's deformer advances
//   measurer.measure(x, reference.context(frame, pose, measurer));
//   outcome.update(reference.record());   remarks.add(reference.remarks());
#pragma once

#include "experiments/characters/remark.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/run/parts_of_one_bone.hpp"
#include "experiments/run/reference_error_bar.hpp"
#include "experiments/run/runners.hpp"
#include "experiments/run/reference_outcome.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace experiments {

class ComparedReference {
public:
    // runner: the first one of the scene, which is its reference if it has one. All arguments must outlive this object.
    ComparedReference(const Scene& scene, const pbs::Character& character, Runner& runner, CostRecord& cost);
    ComparedReference(ComparedReference&&) = delete;

    // After the runner's deformer has foreseen the motion: contact counts only if the frames were solved with it.
    void note_contact();
    void give_up_when(const std::function<bool()>& is_over);
    void advance(const pbs::Pose& pose, double dt_s);

    // The frame's pose, and the reference's positions and error in it where it can be compared with. Makes the measurer
    // leave out the tips of its creases.
    FrameContext context(int frame, const pbs::Pose& pose, FrameMeasurer& measurer);
    // A deformer whose error is not above the reference's in one more frame.
    void add_below_error(const std::string& label) { ++frames_below_error_[label]; }

    // Members of run.json's outcome; none without a reference.
    nlohmann::json record() const;
    pbs::RemarkList remarks() const;
    nlohmann::json error_method() const { return error_bar_ ? error_bar_->method() : nlohmann::json(); }
    bool was_interrupted() const;  // while it was solved

private:
    const ReferenceOutcome* spread() const;  // null: the reference has no budget
    void find_overlap(int frame, const pbs::Positions& positions, const FrameMeasurer& measurer);
    void find_lag(int frame, const pbs::Positions& positions, const pbs::Pose& pose);
    const std::string& bone_that_lags() const;

    const Scene& scene_;
    const pbs::Character& character_;
    Runner& runner_;
    CostRecord& cost_;
    std::optional<ReferenceErrorBar> error_bar_;
    std::optional<PartsOfOneBone> parts_;  // from the first frame that is compared
    int frames_with_lag_ = 0, frames_searched_for_lag_ = 0;
    PartLag largest_lag_;
    int frames_ = 0, frames_with_overlap_ = 0, first_frame_with_overlap_ = 0;
    double largest_masked_share_pct_ = 0.0;
    std::map<std::string, int> frames_below_error_;  // by label
};

}  // namespace experiments
