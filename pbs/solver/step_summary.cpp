#include "pbs/solver/step_summary.hpp"

namespace pbs {

const char* to_string(Outcome outcome)
{
    switch (outcome) {
        case Outcome::finished:
            return "finished";
        case Outcome::not_finite:
            return "not_finite";
        case Outcome::not_converged:
            return "not_converged";
    }
    return "unknown";
}

}  // namespace pbs
