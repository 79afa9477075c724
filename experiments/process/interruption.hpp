// The first SIGINT or SIGTERM ends the work between two frames, so that what was finished is kept; the second ends the program.
#pragma once

namespace experiments {

struct Interrupted {};

void watch_interrupts();
bool interrupted();
void stop_if_interrupted();  // throws Interrupted

}  // namespace experiments
