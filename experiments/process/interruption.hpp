// The first SIGINT or SIGTERM ends the work between two frames, so that finished work is kept. The second ends the program at once.
#pragma once

namespace experiments {

struct Interrupted {};

void watch_interrupts();
bool interrupted();
void stop_if_interrupted();  // throws Interrupted

}  // namespace experiments
