// The initial guesses from which the solver may begin a frame (claim C03). The bind points are always those of the frame; only the
// particles differ when lines 10-14 of Algorithm 1 begin. Nothing jiggles, so the guess is the first argument of PbsSolver::advance.
//   lbs             linear blend skinning, as in the paper
//   previous_frame  the solver's result in the previous frame, which began from the one before it, and so on from the motion's beginning
//   rest_pose       the rest positions, wherever the character is
//   rigid_bind      every vertex moved by its nearest bone alone
//   for (const FrameStarts& frame : starts_of(character, motion, {164, 708}, options)) frame.shapes[int(SolverStart::rest_pose)];
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/solver/options.hpp"

#include <array>
#include <vector>

namespace experiments {

enum class SolverStart { lbs, previous_frame, rest_pose, rigid_bind };
inline constexpr std::array<SolverStart, 4> all_starts = {SolverStart::lbs, SolverStart::previous_frame, SolverStart::rest_pose,
                                                          SolverStart::rigid_bind};

const char* name_of(SolverStart start);  // lbs, previous_frame, ..., as in records and keys

struct FrameStarts {
    pbs::Positions bind_points;            // posed q_i [m], #V x 3
    std::array<pbs::Positions, 4> shapes;  // by SolverStart [m], #V x 3
};

// frames: of the motion, increasing. options: for the steps that lead to previous_frame. Before the first frame it is LBS.
std::vector<FrameStarts> starts_of(const pbs::Character& character, const pbs::Motion& motion, const std::vector<int>& frames,
                                   const pbs::PbsOptions& options);

}  // namespace experiments
