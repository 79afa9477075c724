// The reference of a run that has a budget of processor time for it (reference.seconds). It solves frames that are evenly spread over the
// motion, ever closer to each other, until the time is spent. Each frame continues from the solved one before or after it, or from rest,
// whichever pose is most similar. Frames that are not reached are tried once more in the time that is left. What is solved is kept in a
// file, from which the same run goes on.
//   SpreadReference reference(make_deformer(spec), {.seconds = 120.0, .file = "DIR/reference_frames.cbor"});
//   reference.reset(character);
//   reference.foresee(poses);                                                     // solves
//   for (const pbs::Pose& pose : poses)
//       if (reference.advance(pose, dt_s); reference.has_state()) ... reference.positions() ...
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/process/terminal.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct ReferenceBudget {
    double seconds = 0.0;                   // of processor time, for all frames
    std::string file = {};                  // where solved frames are kept and found again; empty: nowhere
    std::string key = {};                   // of all that the solutions depend on, except for the poses
    bool goes_on_without_the_rest = false;  // after an interruption, which then ends the solving alone
};

// The frames 0 to frames - 1 in the order in which they are solved: the first, the last, and then by the base-2 sequence of J. G. van der
// Corput (1935), so that those solved up to any moment are evenly spread.
std::vector<int> spread_order(int frames);

// The processor time that the next frame may take [s]. The first eight frames share the budget equally. Later ones may take their equal
// share or three times the median of the frames that were reached, whichever is longer. frames: of the motion; tried: those before this
// one; reached_s: the time that each reached frame took.
double share_of_frame(double seconds_left, int frames, int tried, const std::vector<double>& reached_s);

class SpreadReference : public Deformer {
public:
    // spec: a quasi-static [[fem]] deformer.
    SpreadReference(const DeformerSpec& spec, ReferenceBudget budget);

    void reset(const pbs::Character& character) override;
    void foresee(const std::vector<pbs::Pose>& poses) override;             // at least one; pbs::InputError if the file cannot be written
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;  // the next one of the poses
    bool has_state() const override;                                        // whether that frame is solved
    const pbs::Positions& positions() const override { return facts_.last_state; }
    const FemFacts* facts() const override { return &facts_; }
    nlohmann::json record() const override { return deformer_->record(); }

    struct NotReached {
        int frame = 0;
        double seconds = 0.0;
        std::string bone;  // whose flesh is most compressed in the state in which the solver ended
    };
    struct Outcome {
        int frames = 0, solved = 0, kept = 0;         // of the motion; with a solution; those among them that an earlier run had solved
        std::vector<NotReached> not_reached = {};     // that were tried in vain
        double seconds = 0.0;                         // that were spent
        std::optional<NotReached> with_contact = {};  // the frame for which contact was given up
        bool was_interrupted = false;
    };
    const Outcome& outcome() const { return outcome_; }

private:
    struct Solution {
        pbs::StepSummary step = {};
        pbs::Positions positions = {};  // [m], #V x 3
        std::optional<double> lowest_det_f = {};
        std::vector<CreaseTip> tips = {};
    };
    struct Frame {
        pbs::Pose pose, relative;  // in the world, and to the root
        std::optional<Solution> solution = {};
    };

    void solve_all();
    bool tries_contact() const;
    void do_without_contact();
    void find_kept();
    void keep();
    bool has_time_left() const;
    void solve(int number);
    void continue_from_most_similar(int number);
    std::string most_distorted_bone() const;

    DeformerSpec spec_;
    std::unique_ptr<Deformer> deformer_;
    ReferenceBudget budget_;
    const pbs::Character* character_ = nullptr;
    std::vector<Frame> frames_;
    std::vector<double> reached_s_;  // of each frame that was solved here
    int tried_ = 0, frame_ = -1;     // frames that were tried here; the one of the last call of advance
    pbs::Stopwatch since_keeping_;
    std::optional<Progress> progress_;
    FemFacts facts_;
    Outcome outcome_;
};

}  // namespace experiments
