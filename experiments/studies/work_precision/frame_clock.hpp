// The clock of a point's times.
//   words_of(FrameClock::own)  // for readers: "the times that the program states in seconds.f64"
#pragma once

#include "analysis/records/tables.hpp"

#include <string>

namespace experiments {

// processor: processor time of this process. own: the times that a deformer in another process states itself. wall: the wall time of that
// process, divided by the number of its poses.
enum class FrameClock { processor, own, wall };
std::string words_of(FrameClock clock);

}  // namespace experiments

namespace analysis {

template <>
struct EnumNames<experiments::FrameClock> {
    static constexpr std::array<std::pair<experiments::FrameClock, const char*>, 3> table{
        {{experiments::FrameClock::processor, "processor"},
         {experiments::FrameClock::own, "own"},
         {experiments::FrameClock::wall, "wall"}}};
};

}  // namespace analysis
