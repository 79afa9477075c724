#include "analysis/verdict_texts.hpp"

#include "analysis/statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace analysis {

Verdict verdict_of(const Claim& claim, VerdictKind kind, const std::string& text)
{
    Verdict verdict;
    verdict.claim = claim;
    verdict.kind = kind;
    verdict.text = verdict.summary = text.empty() ? label(kind) : fmt::format("{}: {}", label(kind), text);
    verdict.interval = {not_known, not_known, not_known, claim.level, 0, 0};
    return verdict;
}

std::string left_out_text(const std::vector<LeftOut>& left_out)
{
    std::vector<std::string> entries;
    for (const LeftOut& entry : left_out) entries.push_back(fmt::format("{} ({})", entry.scene, entry.reason));
    return fmt::format("{}", fmt::join(entries, ", "));
}

std::string label(VerdictKind kind)
{
    switch (kind) {
        case VerdictKind::reproduced:
            return "reproduced";
        case VerdictKind::reproduced_only_for:
            return "reproduced only for";
        case VerdictKind::not_reproduced:
            return "not reproduced";
        case VerdictKind::inconsistent_in_print:
            return "inconsistent in print";
        case VerdictKind::cannot_be_tested_here:
            return "cannot be tested here";
        default:
            return "not computable";
    }
}

}  // namespace analysis
