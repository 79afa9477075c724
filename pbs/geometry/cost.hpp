// Wall time since construction [s].
#pragma once

#include <chrono>
#include <cstdint>

namespace pbs {

// Uses the steady clock, which is never set back.
class Stopwatch {
public:
    // Time since construction; may be called repeatedly.
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Work that does not depend on the machine, counted by each deformer: what a step costs in the units of its method,
// summed over one step.
//   work += {.tet_visits = tets, .projections = constraints};
// Zero means none: every deformer of this program counts all of its work. Where nothing counts, as in a program of the
// user's own, records have empty cells.
struct WorkCounters {
    std::int64_t gradients = 0;      // gradients of an energy of the whole body, with or without its value
    std::int64_t vertex_visits = 0;  // blends, smoothings, rotations and block solves of one vertex
    std::int64_t tet_visits = 0;     // energies, derivatives, local rotations and volume constraints of one tet
    std::int64_t projections = 0;    // constraints projected
    std::int64_t linear_solves =
        0;  // systems of the whole body solved; three right-hand sides of one matrix, x, y and z, are one
    std::int64_t factorisations = 0;  // numerical factorisations of such a system

    bool operator==(const WorkCounters&) const = default;
    WorkCounters& operator+=(const WorkCounters& more)
    {
        gradients += more.gradients;
        vertex_visits += more.vertex_visits;
        tet_visits += more.tet_visits;
        projections += more.projections;
        linear_solves += more.linear_solves;
        factorisations += more.factorisations;
        return *this;
    }
};

}  // namespace pbs
