// A body with a handle (genus 1): a leg in two strands, a ring drawn long. Its three bones run down the middle of the hole and have the
// human's names, so that clips move it; bent at the knee, both strands bend side by side.
//        .--.      y  pelvis
//       | || |        thigh.L
//       | || |        shin.L
//        '--'
#pragma once

#include "pbs/character/character.hpp"

namespace pbs {

// Tube radius 0.07 m round two strands of 0.72 m, 0.28 m apart, joined by half circles. vertices 0: 1,800.
Character make_ring(int vertices);

}  // namespace pbs
