#include "experiments/studies/work_precision/certainty.hpp"

#include <fmt/format.h>

namespace experiments {

std::optional<bool> is_certain(const Diagram& diagram, const DiagramPoint& nearer, const DiagramPoint& other)
{
    if (!diagram.reference_error_pct) return std::nullopt;
    return other.error_pct - nearer.error_pct > 2.0 * *diagram.reference_error_pct;
}

std::optional<bool> is_certain_from(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other, double from_ms)
{
    std::vector<std::string> both = one.deformers;
    both.insert(both.end(), other.deformers.begin(), other.deformers.end());
    std::vector<std::size_t> indices;
    std::optional<bool> all;
    for (const analysis::WorkPrecision& at : diagram.of(both, indices)) {
        const DiagramPoint *nearer = best_of(diagram, one, at.cost), *than = best_of(diagram, other, at.cost);
        if (at.cost < from_ms || !nearer || !than) continue;
        const std::optional<bool> certain = is_certain(diagram, *nearer, *than);
        if (!certain) return std::nullopt;
        all = all.value_or(true) && *certain;
    }
    return all;
}

std::string remark_on(std::optional<bool> certain, const Diagram& diagram)
{
    if (!certain) return " [undecided: the reference's own error is not known]";
    if (*certain) return "";
    return fmt::format(" [undecided: within the reference's own error of up to {:.2g} %]", *diagram.reference_error_pct);
}

}  // namespace experiments
