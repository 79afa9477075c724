// A character moved by one reading of the paper through a scene's frames, and what comes of it.
//   const ReadMotion moved = move(character, scene, reading);
#pragma once

#include "analysis/case_record.hpp"
#include "experiments/studies/ambiguity/reading.hpp"
#include "experiments/scene/scene.hpp"

#include <vector>

namespace experiments {

struct ReadMotion {
    analysis::CaseRecord pbs, lbs;       // volume, as a verdict is computed from it
    std::vector<pbs::Positions> shapes;  // of PBS, one a frame [m], #V x 3
    bool finite = true;
};

ReadMotion move(const pbs::Character& character, const Scene& scene, const Reading& reading);

}  // namespace experiments
