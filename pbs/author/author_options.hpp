// Options of the deformer that follows the code published by the paper's first author (author_solver.hpp).
#pragma once

#include "pbs/geometry/types.hpp"

namespace pbs {

// The defaults are those of that code, with two exceptions. It has gravity (0, -9.81, 0) in its unit of length, which moves every particle
// by g h^2 = 98 mm a step in metres; here gravity is off, as in the scenes of this project. It leaves the unit of length open; here it is a
// centimetre, for in metres its threshold leaves out every tet of less than some 3 cm.
struct AuthorOptions {
    int iterations = 12;               // per frame; the paper has 24
    double time_step_s = 0.1;          // h, whatever the frame rate; it cancels where there is no gravity
    Vec3 gravity_m_s2 = Vec3::Zero();  // acts on every particle
    double length_unit_m = 0.01;       // metres per unit of length of smallest_gradient2
    double k_compression = 1.0;        // of lengths below their rest length, in [0, 1]
    double k_stretch = 1.0;            // of all other lengths, in [0, 1]
    double k_volume_inverted = 1.0;    // of tets with negative volume, in [0, 6]
    double k_volume = 1.0;             // of all other tets, in [0, 6]; 1 removes a sixth of a volume's error, 6 all of it
};

}  // namespace pbs
