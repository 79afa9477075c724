// The reference of a run that has a budget of processor time for it (reference.seconds): it passes through the motion,
// and as soon as all frames would take longer than what is left, it leaves frames out, so that those which are solved
// are evenly spread up to the end. In the time that is left then it passes through the others, and tries those that
// were not reached once more. It solves every fourth frame first, then every second one, then the rest. After four
// frames that were not reached, and at most one that was, it gives up. A frame continues from the last one, or from the
// solved one before or after it or from rest, whichever pose is most similar. What is solved is kept in a file
// (solved_frames.hpp), from which the same run goes on. reference_outcome.hpp says what was reached.
//
// Contact can make a frame ten times as expensive, since where two parts touch, the initial guess and each step of
// Newton's method end at once for the whole body. As soon as two frames are not reached, these are more than a quarter
// of those that were tried, and half of the time is left, all frames are solved without contact. A larger budget tries
// it again.
//   SpreadReference reference(spec, {.seconds = 120.0, .file = "DIR/reference_frames.cbor", .key = key});
//   reference.reset(character);
//   reference.foresee(poses);                                                     // solves
//   for (const pbs::Pose& pose : poses)
//       if (reference.advance(pose, dt_s); reference.has_state()) ... reference.positions() ...
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/reference_outcome.hpp"
#include "experiments/run/solved_frames.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace experiments {

struct ReferenceBudget {
    double seconds = 0.0;                   // of processor time, for all frames
    std::string file = {};                  // where solved frames are kept and found again; empty: nowhere
    std::string key = {};                   // all that the solutions depend on, except for the poses
    bool goes_on_without_the_rest = false;  // after an interruption, which then ends the solving alone
    std::function<double()> clock_s = process_cpu_s;
};

// The number of frames to go on by, 1 or more, so that the last of frames_left is reached when the time is spent.
// mean_s: the mean time per frame [s].
int stride(int frames_left, double mean_s, double seconds_left);

// The processor time that a frame may take [s]: an eighth of what is left, more if fewer frames are left, and three
// times the mean of those that were reached if there is as much.
double share_of_frame(int frames_left, double mean_reached_s, double seconds_left);

class SpreadReference : public Deformer {
public:
    // spec: a quasi-static [[fem]] deformer.
    SpreadReference(const DeformerSpec& spec, ReferenceBudget budget);

    void reset(const pbs::Character& character) override;
    // at least one; pbs::InputError if the file cannot be written
    void foresee(const std::vector<pbs::Pose>& poses) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;  // the next one of the poses
    bool has_state() const override;                                        // whether that frame is solved
    const pbs::Positions& positions() const override { return facts_.last_state; }
    const FemFacts* facts() const override { return &facts_; }
    nlohmann::json record() const override { return deformer_->record(); }

    const ReferenceOutcome& outcome() const { return outcome_; }

private:
    struct Frame {
        pbs::Pose pose, relative;  // in the world, and to the root
        std::optional<SolvedFrame> solution = {};
    };

    void pass(std::set<int>& left, int least_stride);
    bool is_solved(int number) const { return frames_[static_cast<std::size_t>(number)].solution.has_value(); }
    bool is_held_up_by_contact() const;
    void find_kept(const std::vector<pbs::Pose>& poses);
    void do_without_contact(const FrameNotReached& frame_with_contact);
    bool has_time_left() const;
    void solve(int number, int frames_left);
    void continue_from_most_similar(int number);
    std::string most_distorted_bone() const;

    DeformerSpec spec_;
    std::unique_ptr<Deformer> deformer_;
    ReferenceBudget budget_;
    const pbs::Character* character_ = nullptr;
    std::vector<Frame> frames_;
    SolvedFrames kept_;
    int tried_ = 0;                // frames that were tried here, with contact or without it
    double reached_s_ = 0.0;       // that those took which were reached
    double spent_before_s_ = 0.0;  // before the first of them
    int at_ = -1;                  // the frame whose pose the deformer has; -1: that of none
    int frame_ = -1;               // of the last call of advance
    std::optional<Progress> progress_;
    FemFacts facts_;
    ReferenceOutcome outcome_;
};

}  // namespace experiments
