#include "experiments/studies/work_precision/certainty.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {

Certainty certainty_of(const Diagram& diagram, const DiagramPoint& nearer, const DiagramPoint& other)
{
    if (!diagram.reference_error_pct || !nearer.beside_pct || !other.beside_pct) return Certainty::not_known;
    if (*nearer.beside_pct >= *other.beside_pct) return Certainty::one_solution;
    const bool apart = other.error_pct - nearer.error_pct > 2.0 * *diagram.reference_error_pct;
    return apart ? Certainty::told_apart : Certainty::both_solutions;
}

std::optional<Certainty> certainty_from(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other, double from_ms)
{
    std::vector<std::string> both = one.deformers;
    both.insert(both.end(), other.deformers.begin(), other.deformers.end());
    std::vector<std::size_t> indices;
    std::optional<Certainty> least;
    for (const analysis::WorkPrecision& at : diagram.of(both, indices)) {
        const DiagramPoint *nearer = best_of(diagram, one, at.cost), *than = best_of(diagram, other, at.cost);
        if (at.cost < from_ms || !nearer || !than) continue;
        const Certainty certainty = certainty_of(diagram, *nearer, *than);
        least = least ? std::min(*least, certainty) : certainty;
    }
    return least;
}

std::string words_of(Certainty certainty, const Diagram& diagram)
{
    const std::string differ =
        diagram.reference_difference_pct ? fmt::format("the two solutions differ by {:.1f} %", *diagram.reference_difference_pct) : "";
    switch (certainty) {
        case Certainty::not_known:
            return diagram.reference_error_pct ? " [undecided: one of the two is the second solution itself; " + differ + "]"
                                               : " [undecided: there is no second solution that shows the reference's error]";
        case Certainty::one_solution:
            return fmt::format(" [undecided: the order is reversed against the second solution; {}]", differ);
        case Certainty::both_solutions:
            return fmt::format(" [within the reference's own error of up to {:.1f} %, but the same against both solutions; {}]",
                               *diagram.reference_error_pct, differ);
        case Certainty::told_apart:
            return "";
    }
    return "";
}

}  // namespace experiments
