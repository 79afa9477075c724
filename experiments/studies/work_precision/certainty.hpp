// Whether a statement "this point is nearer than that one" survives the choice of the reference and the references' own errors. Errors are
// distances: relative to the exact solution, each may be larger or smaller by the error of the reference. A reference orders two points if
// their errors differ by more than twice the bound of its own error (analysis/verdicts/pair_order.hpp with |A - B| <= e_A + e_B). A
// statement is decided if every reference of the ensemble orders the points in this way.
//   decision_on(diagram, pbs, delta_mush).remark()
#pragma once

#include "analysis/verdicts/pair_order.hpp"
#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

struct Decision {
    analysis::PairDecision decision = analysis::PairDecision::decided;
    std::string reason = {};  // why it is not decided; empty where it is
    int references = 1;

    bool is_decided() const { return decision == analysis::PairDecision::decided; }
    std::string remark() const;  // follows a sentence; empty where it is decided
};

// `nearer` has the smaller error against the first reference.
Decision decision_on(const Diagram& diagram, const DiagramPoint& nearer, const DiagramPoint& other);

// The worst decision at all times from `from_ms` on, for the best points of both groups. Nothing where one of the two has no points.
std::optional<Decision> decision_from(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other, double from_ms);

}  // namespace experiments
