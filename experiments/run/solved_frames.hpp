// The solved frames of a reference, and the file in which they are kept so that the same run can go on. A frame is
// found again by its pose if all else that its solution depends on (the key) is the same, too.
//   SolvedFrames file("DIR/reference_frames.cbor", key, budget_s);
//   const std::vector<std::optional<SolvedFrame>> found = file.find(poses, character.mesh.rest.rows());
//   file.add(pose, {.step = step, .positions = positions});                     // writes once a second
//   file.write();
// A run that gave contact up keeps its frames without contact. A run with a larger budget does not take them, since its
// time may suffice for contact.
//
// The file is CBOR: {key, budget_s, with_contact, frames: {hash of the pose: {positions, seconds, iterations,
// lowest_det_f, tips}}}.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/run/reference_outcome.hpp"
#include "pbs/geometry/cost.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct SolvedFrame {
    pbs::StepSummary step = {};
    pbs::Positions positions = {};  // [m], #V x 3
    std::optional<double> lowest_det_f = {};
    std::vector<CreaseTip> tips = {};
};

class SolvedFrames {
public:
    // file: empty if nothing is kept. key: all that the solutions depend on, except for the poses. budget_s: the
    // processor time for all frames.
    SolvedFrames(std::string file, std::string key, double budget_s);

    // One entry per pose, with the solution if the file has it. vertices: the number of positions. A damaged file gives
    // no solution and a warning.
    std::vector<std::optional<SolvedFrame>> find(const std::vector<pbs::Pose>& poses, Eigen::Index vertices);
    // The frame for which the frames of the file, or those that were added, gave contact up.
    const std::optional<FrameNotReached>& with_contact() const { return with_contact_; }
    // Forgets the frames with contact. frame: the one that was not reached with it.
    void begin_without_contact(const FrameNotReached& frame);

    // These write the file: add() once a second, write() at once. pbs::InputError if it cannot be written.
    void add(const pbs::Pose& pose, const SolvedFrame& frame);
    void write();

private:
    std::string file_, key_;
    double budget_s_;
    nlohmann::json frames_ = nlohmann::json::object();  // by the hash of the pose, those of other motions too
    std::optional<FrameNotReached> with_contact_;
    pbs::Stopwatch since_writing_;
};

}  // namespace experiments
