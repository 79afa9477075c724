// SIGINT and SIGTERM end the work between two frames, so that what was finished is kept.
#pragma once

namespace experiments {

struct Interrupted {};

void watch_interrupts();
bool interrupted();
void stop_if_interrupted();  // throws Interrupted

}  // namespace experiments
