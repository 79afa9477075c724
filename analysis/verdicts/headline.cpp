#include "analysis/verdicts/headline.hpp"

#include "analysis/records/report_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string>

namespace analysis {
namespace {

const std::vector<std::string> facts = {"held", "n", "least", "most", "least_pct", "most_pct", "unit"};

// A text followed by a placeholder, which is empty at the end of a headline.
struct Part {
    std::string text, placeholder;
};

// The parts of a headline; an open brace without a closing one stays in the text.
std::vector<Part> parts_of(const std::string& headline)
{
    std::vector<Part> parts;
    std::size_t begin = 0;
    for (std::size_t open = 0; (open = headline.find('{', begin)) != std::string::npos;) {
        const std::size_t close = headline.find('}', open);
        if (close == std::string::npos) break;
        parts.push_back({headline.substr(begin, open - begin), headline.substr(open + 1, close - open - 1)});
        begin = close + 1;
    }
    parts.push_back({headline.substr(begin), ""});
    return parts;
}

// {FACT}, {FACT of NAME} or {FACT at FIELD=VALUE}
struct Placeholder {
    std::string fact = {}, name = {}, field = {}, value = {};
};

Placeholder placeholder_of(const std::string& text)
{
    const std::size_t of = text.find(" of "), at = text.find(" at "), equals = text.find('=');
    if (of != std::string::npos) return {.fact = text.substr(0, of), .name = text.substr(of + 4)};
    if (at == std::string::npos || equals == std::string::npos || equals < at) return {.fact = text};
    return {
        .fact = text.substr(0, at), .field = text.substr(at + 4, equals - at - 4), .value = text.substr(equals + 1)};
}

bool is_number(const std::string& fact)
{
    return fact.starts_with("least") || fact.starts_with("most");
}

std::string fault_of(const Claim& claim, const std::string& text)
{
    const Placeholder placeholder = placeholder_of(text);
    if (std::ranges::count(facts, placeholder.fact) == 0)
        return fmt::format("{{{}}}: expected {}", text, fmt::join(facts, ", "));
    if (!placeholder.name.empty() && std::ranges::count(claim.others, placeholder.name, &Selection::name) == 0)
        return fmt::format("{{{}}}: expected the name of a control or comparison of the claim", text);
    if (!placeholder.field.empty() && !case_key_field(placeholder.field))
        return fmt::format("{{{}}}: expected a field of a key", text);
    return "";
}

// 0.53, 6.4, 17, 1.9e-6
std::string rounded(double value)
{
    std::string text = std::abs(value) < 10.0 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
    if (const std::size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
    return text;
}

bool has_value(const JudgedCase& tested, const Placeholder& placeholder)
{
    if (!tested.counts() || !std::isfinite(tested.value)) return false;
    const CaseKeyField* field = placeholder.field.empty() ? nullptr : case_key_field(placeholder.field);
    return !field || value_text(*field, tested.of) == placeholder.value;
}

// Empty if it is not known.
std::string end_text(const Judged& judged, const Placeholder& placeholder)
{
    static constexpr std::array signs = {"", ">= ", "<= ", "> "};
    std::vector<JudgedCase> cases;
    std::ranges::copy_if(judged.cases, std::back_inserter(cases),
                         [&](const JudgedCase& tested) { return has_value(tested, placeholder); });
    if (cases.empty()) return "";
    const auto [least, most] = std::ranges::minmax_element(cases, {}, &JudgedCase::value);
    const JudgedCase& end = placeholder.fact.starts_with("least") ? *least : *most;
    return signs[static_cast<std::size_t>(end.limit)] +
           rounded((placeholder.fact.ends_with("_pct") ? 100.0 : 1.0) * end.value);
}

std::string text_of(const Verdict& verdict, const Placeholder& placeholder)
{
    const auto named = std::ranges::find(verdict.others, placeholder.name, [](const Judged& judged_selection) {
        return judged_selection.selection.name;
    });
    if (!placeholder.name.empty() && named == verdict.others.end()) return "";
    const Judged& judged = placeholder.name.empty() ? verdict.own : *named;
    if (is_number(placeholder.fact)) return end_text(judged, placeholder);
    if (placeholder.fact == "unit") return judged.cases.empty() ? "" : judged.cases.front().unit;
    if (!verdict.printed.empty())
        return placeholder.fact == "n"
                   ? std::to_string(verdict.printed.size())
                   : std::to_string(std::ranges::count_if(verdict.printed, &PrintedValue::is_consistent));
    return judged.n == 0 ? "" : std::to_string(placeholder.fact == "n" ? judged.n : judged.held);
}

}  // namespace

std::string short_name_fault(const Claim& claim)
{
    std::istringstream stream(claim.short_name);
    std::size_t words = 0;
    for (std::string word; stream >> word;) ++words;
    if (words == 0 || words > most_short_words || characters(claim.short_name) > most_short_characters)
        return fmt::format("expected 1 to {} words of at most {} characters in all", most_short_words,
                           most_short_characters);
    return "";
}

std::string headline_fault(const Claim& claim)
{
    std::string text;
    for (const Part& part : parts_of(claim.headline)) {
        if (!part.placeholder.empty())
            if (const std::string fault = fault_of(claim, part.placeholder); !fault.empty()) return fault;
        text += part.text;
    }
    if (text.find_first_of("{}") != std::string::npos || claim.headline.find("{}") != std::string::npos)
        return "expected each { with its } and a fact between them";
    if (std::ranges::any_of(text, [](unsigned char letter) { return std::isdigit(letter); }))
        return "expected numbers only as {placeholders}";
    if (claim.headline.empty() || characters(text) > most_headline_characters)
        return fmt::format("expected 1 to {} characters besides the placeholders", most_headline_characters);
    return "";
}

std::string measured_text(const Verdict& verdict)
{
    std::string text;
    for (const Part& part : parts_of(verdict.claim.headline)) {
        text += part.text;
        if (part.placeholder.empty()) continue;
        const std::string filled = text_of(verdict, placeholder_of(part.placeholder));
        if (filled.empty()) return "";
        text += filled;
    }
    return text;
}

std::string asked_text(const Claim& claim)
{
    if (claim.rule == ClaimRule::printed) return "all";
    bool has_numbers = false, in_percent = false, has_unit = false;
    for (const Part& part : parts_of(claim.headline)) {
        const Placeholder placeholder = placeholder_of(part.placeholder);
        has_numbers |= is_number(placeholder.fact) && placeholder.name.empty();
        in_percent |= placeholder.fact.ends_with("_pct");
        has_unit |= placeholder.fact == "unit";
    }
    if (claim.rule == ClaimRule::cases && !has_numbers) return fmt::format("{:.0f} %", 100.0 * holding_share);
    std::vector<std::string> texts;
    for (Threshold threshold : claim.own.thresholds) {
        if (!threshold.quantity.empty() && threshold.quantity != claim.own.quantities.front()) continue;
        if (in_percent) {
            threshold.low *= 100.0;
            threshold.high *= 100.0;
        }
        const auto named = std::ranges::find(claim.quantities, claim.own.quantities.front(), &Quantity::name);
        std::string unit = in_percent ? " %" : has_unit && named != claim.quantities.end() ? " " + named->unit : "";
        std::string text = threshold_text(threshold);
        const std::size_t end = std::min(text.find(" or "), text.size());
        texts.push_back(text.insert(end, unit));
    }
    return fmt::format("{}", fmt::join(texts, ", "));
}

std::string threshold_text(const Threshold& threshold)
{
    const bool has_low = std::isfinite(threshold.low), has_high = std::isfinite(threshold.high);
    if (!has_low && !has_high) return "";
    if (threshold.low == threshold.high) return fmt::format("{:.4g}", threshold.low);
    if (!has_high)
        return threshold.low > 0.0 && threshold.low <= 1e-9 ? "above 0" : fmt::format("{:.4g} or more", threshold.low);
    if (has_low) return fmt::format("{:.4g} to {:.4g}", threshold.low, threshold.high);
    const bool is_round = threshold.high == std::stod(fmt::format("{:.15g}", threshold.high));
    return is_round ? fmt::format("{:.4g} or less", threshold.high) : fmt::format("below {:.4g}", threshold.high);
}

}  // namespace analysis
