#include "experiments/studies/work_precision/diagram.hpp"

#include <algorithm>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::PairOrder;
using analysis::within;

constexpr double answered_budgets_ms[] = {0.1, 1.0, 10.0};

const Columns<NearestQuestion> question_columns =
    Columns<NearestQuestion>{{"comparison", &NearestQuestion::comparison}, {"case", &NearestQuestion::diagram}} +
    MEMBER_COLUMNS(NearestQuestion, budget_ms, among);

// The deformers of one of the groups, each as a group of its own.
std::vector<DeformerGroup> deformers_of(const DeformerGroup& group)
{
    std::vector<DeformerGroup> deformers;
    for (const std::string& name : group.deformers) deformers.push_back({name, {name}});
    return deformers;
}

// Compares the groups by their best points within the time. Nothing where none has a point.
std::optional<NearestAnswer> answer_to(const NearestQuestion& question, const Diagram& chosen, const Diagram& defaults,
                                       const std::vector<DeformerGroup>& groups, std::vector<NearestPair>& pairs)
{
    const DeformerGroup* nearest = nullptr;
    const DiagramPoint* best = nullptr;
    for (const DeformerGroup& group : groups)
        if (const DiagramPoint* point = best_of(chosen, group, question.budget_ms); point && (!best || point->error_pct < best->error_pct))
            nearest = &group, best = point;
    if (!best) return std::nullopt;
    NearestAnswer answer{question, nearest->key, *best};
    for (const DeformerGroup& other : groups) {
        if (&other == nearest || !best_of(chosen, other, question.budget_ms)) continue;
        std::vector<PairOrder> orders;
        for (const auto& [settings, diagram] : {std::pair{SettingsOf::training_poses, &chosen}, {SettingsOf::defaults, &defaults}}) {
            const DiagramPoint *first = best_of(*diagram, *nearest, question.budget_ms),
                               *second = best_of(*diagram, other, question.budget_ms);
            const auto by_all = first && second ? orders_on(*diagram, *first, *second) : std::vector<ReferenceOrder>{};
            if (by_all.empty()) orders.push_back(PairOrder::undecided);  // no default setting is as fast
            for (const ReferenceOrder& by : by_all) {
                pairs.push_back({question, nearest->key, other.key, first->key.deformer, second->key.deformer, settings, by});
                orders.push_back(by.order);
            }
        }
        ++answer.others;
        const analysis::PairDecision decision = analysis::decide(orders);
        if (decision != analysis::PairDecision::decided) answer.either_of.push_back(other.key);
        answer.decision = std::max(answer.decision.value_or(decision), decision);
    }
    return answer;
}

}  // namespace

const Columns<NearestPair> nearest_pair_columns = within(&NearestPair::of, question_columns) +
                                                  MEMBER_COLUMNS(NearestPair, first, second, first_deformer, second_deformer, settings) +
                                                  within(&NearestPair::by, reference_order_columns());

const Columns<NearestAnswer> nearest_columns =
    within(&NearestAnswer::of, question_columns) + Columns<NearestAnswer>{{"nearest", &NearestAnswer::nearest}} +
    within(&NearestAnswer::point, diagram_point_columns()) + MEMBER_COLUMNS(NearestAnswer, others, either_of, decision);

NearestAnswers nearest_classes(const std::vector<Diagram>& chosen, const std::vector<Diagram>& defaults)
{
    NearestAnswers all;
    for (const Diagram& diagram : chosen) {
        if (!diagram.has_reference || diagram.half == Half::training) continue;
        const auto of_defaults = std::ranges::find_if(
            defaults, [&](const Diagram& one) { return one.comparison == diagram.comparison && one.key == diagram.key; });
        if (of_defaults == defaults.end()) continue;
        const std::vector<DeformerGroup> classes = classes_of(diagram.groups);
        for (const double budget_ms : answered_budgets_ms) {
            NearestQuestion question{diagram.comparison, diagram.key, budget_ms};
            const std::optional<NearestAnswer> answer = answer_to(question, diagram, *of_defaults, classes, all.pairs);
            if (!answer) continue;
            all.answers.push_back(*answer);
            question.among = answer->nearest;
            const DeformerGroup& nearest = *std::ranges::find(classes, answer->nearest, &DeformerGroup::key);
            if (const auto within_class = answer_to(question, diagram, *of_defaults, deformers_of(nearest), all.pairs))
                all.answers.push_back(*within_class);
        }
    }
    return all;
}

}  // namespace experiments
