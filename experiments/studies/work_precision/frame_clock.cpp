#include "experiments/studies/work_precision/frame_clock.hpp"

namespace experiments {

std::string words_of(FrameClock clock)
{
    switch (clock) {
        case FrameClock::processor:
            return "processor time, as of all other deformers";
        case FrameClock::own:
            return "the times that the program states in seconds.f64";
        case FrameClock::wall:
            return "the wall time of the program with its start, divided by the number of its poses";
    }
    return "";
}

}  // namespace experiments
