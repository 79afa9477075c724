// A progress bar with the time left, on stderr if that is a terminal.
#pragma once

#include "pbs/geometry/cost.hpp"

#include <string>

namespace experiments {

class Progress {
public:
    Progress(std::string label, int total);
    ~Progress();
    void advance_to(int done);

private:
    std::string label_;
    int total_;
    bool shown_;
    double last_drawn_s_ = -1.0;
    pbs::Stopwatch stopwatch_;
};

void hide_progress();  // for --quiet and in worker processes
void show_progress();  // undoes hide_progress

}  // namespace experiments
