#include "experiments/studies/work_precision/reference_set.hpp"

namespace experiments {

ReferenceSet::ReferenceSet(const WorkPrecisionCase& of, const pbs::Character& character, const PosePair& poses)
    : of_(of.of), first_(character, reference_flesh(of.scene), poses.pose, poses.time_step_s, of.reference_is_refined)
{
    for (const EnsembleMember& member : of.members)
        members_.push_back(
            {member, PosedReference(character, flesh_of(reference_flesh(of.scene), member), poses.pose, poses.time_step_s, false)});
}

void ReferenceSet::add_errors(PointRow& row, const pbs::Positions& positions) const
{
    if (first_.is_reached()) {
        row.error = first_.error_of(positions);
        row.error_whole_joint_pct = first_.error_on_whole_body(positions).joint_pct;
    }
    for (const Member& one : members_)
        if (one.reference.is_reached()) row.members.at(place_among_further(one.member.name)) = one.reference.error_of(positions).joint_pct;
}

std::vector<FamilyRow> ReferenceSet::member_rows() const
{
    std::vector<FamilyRow> rows;
    for (const Member& one : members_) {
        FamilyRow& row = rows.emplace_back();
        row.of = of_;
        row.member = one.member;
        row.outcome = one.reference.is_reached() ? "reached" : "not_reached";
        row.error_bound_pct = unrefined_bound_pct(first_);
        row.masked_share_pct = one.reference.masked_share_pct();
        for (const NestedSolution& solution : one.reference.solutions()) row.solve_s += solution.seconds;
    }
    return rows;
}

std::optional<double> unrefined_bound_pct(const PosedReference& reference)
{
    if (!reference.is_reached() || !reference.order()) return std::nullopt;
    for (const NestedSolution& solution : reference.solutions())
        if (solution.element_order == 2 && solution.refinements == 0 && solution.finished)
            return reference.error_of(solution.positions).joint_pct + reference.bound().joint_pct;
    return std::nullopt;
}

}  // namespace experiments
