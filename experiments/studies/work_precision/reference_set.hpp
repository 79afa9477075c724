// The references of one case: the first member of the family (shared/posed_reference.hpp) and further ones.
//   ReferenceSet references(of, character, poses);
//   references.add_errors(row, positions);
#pragma once

#include "experiments/studies/work_precision/posed_deformer.hpp"
#include "experiments/studies/work_precision/work_precision_case.hpp"

#include <deque>

namespace experiments {

class ReferenceSet {
public:
    // The character outlives it.
    ReferenceSet(const WorkPrecisionCase& of, const pbs::Character& character, const PosePair& poses);

    const PosedReference& first() const { return first_; }
    // The errors of these positions of the case's own vertices [m], #V x 3, against each reference that was reached.
    void add_errors(PointRow& row, const pbs::Positions& positions) const;
    std::vector<FamilyRow> member_rows() const;

private:
    struct Member {
        EnsembleMember member;
        PosedReference reference;
    };
    analysis::CaseKey of_;
    PosedReference first_;
    std::deque<Member> members_;
};

// The bound of the error of a reference's own solution with quadratic elements on the case's own tets: its distance from the finest
// solution and the bound of that one. Nothing where there is no bound.
std::optional<double> unrefined_bound_pct(const PosedReference& reference);

}  // namespace experiments
