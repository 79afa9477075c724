// Pieces that every rule's verdict is put together from.
#pragma once

#include "analysis/verdict.hpp"

namespace analysis {

// A verdict of that kind without cases; its text is the kind's label and, where there is one, `text`.
Verdict verdict_of(const Claim& claim, VerdictKind kind, const std::string& text);

std::string left_out_text(const std::vector<LeftOut>& left_out);  // man (not installed: ...), lady (...)

}  // namespace analysis
