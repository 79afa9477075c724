#include "analysis/verdicts/verdict.hpp"

#include "analysis/records/report_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <set>

namespace analysis {
namespace {

using nlohmann::json;

// JSON has no infinity; null stands for it, as for values that are not known.
json finite(double value)
{
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json to_json_of(const Interval& interval)
{
    return {{"estimate", finite(interval.estimate)},
            {"low", finite(interval.low)},
            {"high", finite(interval.high)},
            {"level", interval.level},
            {"n", interval.n},
            {"block", interval.block}};
}

json to_json_of(const LeftOut& out)
{
    return {{"scene", out.scene}, {"reason", out.reason}};
}

json to_json_of(const SubjectCount& subject)
{
    return {{"name", subject.name}, {"within", subject.within}, {"n", subject.all}, {"holds", name_of(subject.extent)}};
}

json to_json_of(const FailingFrame& failing)
{
    return {{"frame", failing.frame},
            {"time_s", failing.time_s},
            {"angle_deg", finite(failing.angle_deg)},
            {"value", finite(failing.value)},
            {"inverted_tets", failing.inverted_tets}};
}

json to_json_of(const CaseJudgement& judged);
json to_json_of(const OrderVerdict& verdict);

template <typename List>
json list_of(const List& all)
{
    json list = json::array();
    for (const auto& one : all) list.push_back(to_json_of(one));
    return list;
}

// The number on which the claim's rule is based: the share of frames, or the mean.
json to_json_of(const CaseJudgement& judged)
{
    const bool by_share = judged.rule == ClaimRule::share_within;
    const Interval& deciding = by_share ? judged.share : judged.mean;
    json angles = json::array();
    for (const AngleRange& range : judged.angles) angles.push_back({range.from_deg, range.to_deg});
    json object = to_json_of(judged.of);
    object.update({{"quantity", judged.metric},
                   {"statistic", by_share ? "share_of_frames" : "mean"},
                   {"unit", by_share ? "1" : "%"},
                   {"value", finite(deciding.estimate)},
                   {"low", finite(deciding.low)},
                   {"high", finite(deciding.high)},
                   {"holds", name_of(judged.extent)},
                   {"scene", judged.scene},
                   {"run", judged.run},
                   {"frames", judged.frames},
                   {"sweep", judged.sweep},
                   {"mean", to_json_of(judged.mean)},
                   {"share_of_frames", to_json_of(judged.share)},
                   {"held_angles_deg", angles},
                   {"last_angle_deg", judged.sweep ? json(judged.last_angle_deg) : json(nullptr)},
                   {"least", finite(judged.least)},
                   {"most", finite(judged.most)},
                   {"holding_with_inverted_tets", judged.holding_with_inverted_tets},
                   {"deepest", list_of(judged.deepest)}});
    return object;
}

json to_json_of(const Measurement& measured)
{
    json object = to_json_of(measured.of);
    object.update({{"quantity", measured.quantity},
                   {"unit", measured.unit},
                   {"value", finite(measured.value)},
                   {"low", finite(measured.low)},
                   {"high", finite(measured.high)},
                   {"run", measured.run}});
    if (measured.limit != Limit::none) object["limit"] = recorded_name(measured.limit);
    if (measured.n > 0) object["n"] = measured.n;
    if (measured.not_reached > 0) object["not_reached"] = measured.not_reached;
    return object;
}

json to_json_of(const Claim& claim, const Measurement& measured)
{
    json object = to_json_of(measured);
    object["holds"] = name_of(extent_of(claim, measured));
    return object;
}

json to_json_of(const PrintedValue& value)
{
    json object = to_json_of(value.of);
    object.update({{"quantity", value.quantity},
                   {"value", finite(value.printed)},
                   {"low", finite(value.printed)},
                   {"high", finite(value.printed)},
                   {"bound_low", finite(value.least)},
                   {"bound_high", finite(value.most)},
                   {"holds", name_of(value.is_consistent() ? Extent::whole : Extent::none)}});
    return object;
}

json to_json_of(const OrderVerdict& verdict)
{
    return {{"order", verdict.order},           {"precision", verdict.precision},
            {"verdict", name_of(verdict.kind)}, {"own_verdict", name_of(verdict.own_kind)},
            {"same", verdict.same()},           {"differing", verdict.differing},
            {"cases", list_of(verdict.cases)}};
}

json primary_of(const Verdict& verdict)
{
    if (!verdict.primary) return nullptr;
    const PrimaryFact& primary = *verdict.primary;
    json object = to_json_of(primary.of);
    object.update({{"quantity", primary.quantity},
                   {"statistic", primary.statistic},
                   {"unit", primary.unit},
                   {"value", finite(primary.value)},
                   {"low", finite(primary.low)},
                   {"high", finite(primary.high)},
                   {"n", verdict.n},
                   {"within", verdict.within},
                   {"bound_low", finite(primary.bound_low)},
                   {"bound_high", primary.bound_high >= open_end ? json(nullptr) : json(primary.bound_high)},
                   {"share", verdict.n > 0 ? json(double(verdict.within) / verdict.n) : json(nullptr)}});
    return object;
}

// The quantities of the claim and their bounds.
json bounds_of(const Claim& claim)
{
    json bounds = json::array();
    if (claim.rule == ClaimRule::printed) return bounds;  // each value has a bound of its own
    for (const std::string& quantity : claim.metrics) {
        const QuantityBound bound = bound_of(claim, quantity);
        bounds.push_back(
            {{"quantity", quantity}, {"low", finite(bound.low)}, {"high", bound.high >= open_end ? json(nullptr) : json(bound.high)}});
    }
    return bounds;
}

json cases_of(const Verdict& verdict)
{
    json cases = list_of(verdict.cases);
    for (const Measurement& measured : verdict.measurements) cases.push_back(to_json_of(verdict.claim, measured));
    for (const PrintedValue& value : verdict.printed) cases.push_back(to_json_of(value));
    return cases;
}

json controls_of(const Verdict& verdict)
{
    json controls = list_of(verdict.compared);
    for (const Measurement& measured : verdict.controls) controls.push_back(to_json_of(measured));
    return controls;
}

json claim_object(const Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    const bool by_mean = claim.rule == ClaimRule::mean_within, by_share = claim.rule == ClaimRule::share_within;
    return {{"id", claim.id},
            {"statement", claim.statement},
            {"place", claim.place},
            {"study", claim.study},
            {"rule", name_of(claim.rule)},
            {"reason", claim.reason},
            {"verdict", name_of(verdict.kind)},
            {"primary", primary_of(verdict)},
            {"n", verdict.n},
            {"within", verdict.within},
            {"bounds", bounds_of(claim)},
            {"expected", by_mean || by_share ? json(claim.expected) : json(nullptr)},
            {"required_share", by_share ? json(claim.share) : json(nullptr)},
            {"interval", verdict.interval.n > 0 ? to_json_of(verdict.interval) : json(nullptr)},
            {"subject", claim.subject},
            {"subjects", list_of(verdict.subjects)},
            {"each", claim.each},
            {"of", to_json_of(claim.of)},
            {"cases", cases_of(verdict)},
            {"controls", controls_of(verdict)},
            {"readings", list_of(verdict.orders)},
            {"left_out", list_of(verdict.left_out)},
            {"missing", verdict.missing},
            {"runs", verdict.runs}};
}

json quantities_of(const std::vector<Verdict>& verdicts)
{
    json quantities = json::object();
    for (const Verdict& verdict : verdicts)
        for (const Quantity& quantity : verdict.claim.quantities)
            quantities[quantity.name] = {{"title", quantity.title}, {"unit", quantity.unit}};
    return quantities;
}

// A cell of a Markdown table: one line, with vertical bars escaped.
std::string markdown_cell(const std::string& text)
{
    std::string cell;
    for (char c : text) {
        if (c == '|') cell += '\\';
        cell += c == '\n' ? ' ' : c;
    }
    return cell;
}

const char* colour_of(VerdictKind kind)
{
    constexpr const char *green = "\033[32m", *yellow = "\033[33m", *red = "\033[31m", *purple = "\033[35m", *grey = "\033[90m";
    constexpr const char* colours[] = {green, yellow, red, purple, grey, red};  // in the order of the enum
    return colours[static_cast<int>(kind)];
}

// The primary value in columns of text; all are empty if there is none.
struct PrimaryTexts {
    std::string quantity, value, interval, bound, of;  // volume_change_pct, share_of_frames; 0.42; [0.31, 0.5]; 0.95 to 1; human, 01_01
};

PrimaryTexts texts_of_primary(const Verdict& verdict)
{
    if (!verdict.primary) return {};
    const PrimaryFact& primary = *verdict.primary;
    const bool plain = primary.statistic == "value" || primary.statistic == "printed";
    const bool has_interval = primary.low != primary.high && !std::isnan(primary.low);
    const std::string unit = primary.unit.empty() || primary.unit == "1" ? "" : " " + primary.unit;
    return {plain ? primary.quantity : fmt::format("{} of {}", primary.statistic, primary.quantity),
            fmt::format("{:.3g}{}", primary.value, unit), has_interval ? fmt::format("[{:.3g}, {:.3g}]", primary.low, primary.high) : "",
            bound_text({"", primary.bound_low, primary.bound_high}), text_of(primary.of)};
}

struct Layout {
    std::size_t id, verdict, statement, facts;
};

Layout layout_of(const std::vector<Verdict>& verdicts, std::size_t width)
{
    Layout layout = {.id = 2, .verdict = 14, .statement = 0, .facts = 0};
    for (const Verdict& verdict : verdicts) layout.id = std::max(layout.id, characters(verdict.claim.id));
    const std::size_t rest = std::max<std::size_t>(width, 60) - layout.id - layout.verdict - 6;
    layout.statement = rest * 2 / 5;
    layout.facts = rest - layout.statement;
    return layout;
}

std::string spoken(VerdictKind kind)
{
    std::string name = name_of(kind);
    if (name == "reproduced_only_for") return "reproduced in part";
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

// One line each: how many values hold; the primary value with its bound; its case; what is missing.
std::string facts_text(const Verdict& verdict)
{
    std::vector<std::string> lines;
    if (verdict.n > 0) lines.push_back(fmt::format("within the bound: {} of {}", verdict.within, verdict.n));
    if (const PrimaryTexts primary = texts_of_primary(verdict); !primary.value.empty()) {
        const std::string interval = primary.interval.empty() ? "" : " " + primary.interval;
        lines.push_back(fmt::format("{}: {}{}; bound {}", primary.quantity, primary.value, interval, primary.bound));
        if (!primary.of.empty()) lines.push_back(fmt::format("of: {}", primary.of));
    }
    if (!verdict.claim.reason.empty()) lines.push_back("reason: " + verdict.claim.reason);
    if (!verdict.missing.empty()) lines.push_back(fmt::format("no record: {}", fmt::join(verdict.missing, ", ")));
    return fmt::format("{}", fmt::join(lines, "\n"));
}

// What the claims leave out, e.g. a body that is not installed, each reason once; then the number of verdicts of each kind.
std::vector<std::string> closing_texts(const std::vector<Verdict>& verdicts)
{
    std::map<std::string, std::set<std::string>> left_out;
    for (const Verdict& verdict : verdicts)
        for (const LeftOut& out : verdict.left_out) left_out[out.reason].insert(verdict.claim.id);
    std::vector<std::string> texts, counts;
    for (const auto& [reason, claims] : left_out) texts.push_back(fmt::format("left out of {}: {}", fmt::join(claims, ", "), reason));
    for (int k = 0; k <= static_cast<int>(VerdictKind::not_computable); ++k) {
        const auto count = std::ranges::count(verdicts, static_cast<VerdictKind>(k), &Verdict::kind);
        if (count > 0) counts.push_back(fmt::format("{} {}", count, spoken(static_cast<VerdictKind>(k))));
    }
    texts.push_back(fmt::format("{} claim{}: {}", verdicts.size(), verdicts.size() == 1 ? "" : "s", fmt::join(counts, ", ")));
    return texts;
}

}  // namespace

json claims_json(const std::vector<Verdict>& verdicts, const std::string& revision)
{
    json claims = json::array();
    for (const Verdict& verdict : verdicts) claims.push_back(claim_object(verdict));
    return {{"schema", 2}, {"revision", revision}, {"quantities", quantities_of(verdicts)}, {"claims", claims}};
}

std::string claims_markdown(const std::vector<Verdict>& verdicts)
{
    std::string text =
        "| id | statement | verdict | within | n | quantity | value | interval | bound | case | study |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Verdict& verdict : verdicts) {
        const PrimaryTexts primary = texts_of_primary(verdict);
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", markdown_cell(verdict.claim.id),
                            markdown_cell(verdict.claim.statement), name_of(verdict.kind), verdict.within, verdict.n, primary.quantity,
                            primary.value, primary.interval, primary.bound, markdown_cell(primary.of), verdict.claim.study);
    }
    return text;
}

std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours)
{
    const Layout layout = layout_of(verdicts, width);
    const std::size_t whole = std::max<std::size_t>(width, 60);
    std::string table = side_by_side({{"", layout.id}, {"verdict", layout.verdict}, {"claim", layout.statement}, {"facts", layout.facts}});
    table += std::string(whole, '-') + "\n";
    for (const Verdict& verdict : verdicts)
        table += side_by_side({{verdict.claim.id, layout.id},
                               {spoken(verdict.kind), layout.verdict, colours ? colour_of(verdict.kind) : ""},
                               {fmt::format("{} ({})", verdict.claim.statement, verdict.claim.place), layout.statement},
                               {facts_text(verdict), layout.facts}}) +
                 "\n";
    for (const std::string& text : closing_texts(verdicts))
        for (const std::string& line : wrapped(text, whole)) table += line + "\n";
    return table;
}

}  // namespace analysis
