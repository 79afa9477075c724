#include "analysis/verdicts/claims.hpp"

#include "analysis/records/toml_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

namespace analysis {
namespace {

using pbs::InputError;

const std::map<std::string, ClaimRule> rules = {{"share_within", ClaimRule::share_within},
                                                {"mean_within", ClaimRule::mean_within},
                                                {"measured", ClaimRule::measured},
                                                {"printed", ClaimRule::printed},
                                                {"untestable", ClaimRule::untestable}};

const std::set<std::string> measurable = {"volume_loss_pct", "volume_change_pct", "volume_abs_change_pct"};

// of = { deformer = "pbs", ... }
CaseKey read_key(TomlKeys& claim, const std::string& file)
{
    claim.mark_read("of");
    const toml::node* node = claim.node("of");
    CaseKey key;
    if (!node) return key;
    if (!node->is_table()) claim.refuse("of", "expected { field = value }");
    TomlKeys fields(*node->as_table(), file, "key");
    for (const CaseKeyField& field : case_key_fields()) {
        if (field.text)
            fields.optional(field.name, key.*field.text);
        else if (double value = 0.0; fields.has(field.name)) {
            fields.optional(field.name, value);
            key.*field.number = value;
        }
    }
    fields.require_nothing_unknown();
    return key;
}

// [{ quantity, low, high }, ...]
std::vector<QuantityBound> read_bounds(TomlKeys& claim, const std::string& file)
{
    claim.mark_read("bounds");
    const toml::node* node = claim.node("bounds");
    if (!node) return {};
    if (!node->is_array()) claim.refuse("bounds", "expected a list");
    std::vector<QuantityBound> bounds;
    for (const toml::node& entry : *node->as_array()) {
        if (!entry.is_table()) claim.refuse("bounds", "expected { quantity, low, high }");
        TomlKeys keys(*entry.as_table(), file, "claim");
        QuantityBound& bound = bounds.emplace_back();
        keys.required("quantity", bound.quantity);
        keys.optional("low", bound.low);
        keys.optional("high", bound.high);
        keys.require_nothing_unknown();
        if (!(bound.low <= bound.high)) keys.refuse("low", "expected low <= high");
    }
    return bounds;
}

void require_bounds(const Claim& claim, const TomlKeys& reader)
{
    const auto bounded = [&](const std::string& quantity) {
        return std::any_of(claim.bounds.begin(), claim.bounds.end(), [&](const auto& bound) { return bound.quantity == quantity; });
    };
    for (const QuantityBound& bound : claim.bounds)
        if (!std::count(claim.metrics.begin(), claim.metrics.end(), bound.quantity))
            reader.refuse("bounds", bound.quantity + ": expected one of this claim's metrics");
    if (!reader.has("low") && !reader.has("high") && !std::all_of(claim.metrics.begin(), claim.metrics.end(), bounded))
        reader.refuse("bounds", "expected a bound for each of the metrics, or low and high");
}

void require_judgeable(const Claim& claim, const TomlKeys& reader)
{
    const bool by_records = claim.rule == ClaimRule::share_within || claim.rule == ClaimRule::mean_within;
    if (by_records && claim.metrics.empty()) reader.refuse("metrics", "expected at least one");
    const bool measured = claim.rule == ClaimRule::measured;
    if (measured && claim.metrics.empty()) reader.refuse("metrics", "expected at least one");
    if (measured && !(claim.low <= claim.high)) reader.refuse("low", "expected low <= high");
    if (measured) require_bounds(claim, reader);
    if (!case_key_field(claim.subject)) reader.refuse("subject", "expected a field of a key, as body or masses");
    for (const std::string& field : claim.each)
        if (!case_key_field(field)) reader.refuse("each", field + ": expected fields of a key, as body, deformer or joint");
    for (const auto& metric : claim.metrics)
        if (by_records && !measurable.contains(metric))
            reader.refuse("metrics", fmt::format("{}: expected one of {}", metric, fmt::join(measurable, ", ")));
    if (by_records && claim.deformer.empty()) reader.refuse("deformer", "missing in this claim");
    if (by_records && !(claim.low < claim.high)) reader.refuse("low_pct", "expected low_pct < high_pct");
    if (!(claim.share > 0.0 && claim.share <= 1.0)) reader.refuse("share", "expected 0 < share <= 1");
    if (!(claim.part > 0.0 && claim.part <= claim.share)) reader.refuse("part", "expected 0 < part <= share");
    if (!(claim.level > 0.0 && claim.level < 1.0)) reader.refuse("level", "expected 0 < level < 1");
    if (claim.iterations < 0) reader.refuse("iterations", "expected >= 0");
    if (claim.rule == ClaimRule::untestable && claim.reason.empty()) reader.refuse("reason", "missing in this claim");
}

Claim read_claim(const toml::table& table, const std::string& file)
{
    TomlKeys reader(table, file, "claim");
    Claim claim;
    std::string rule;
    reader.required("id", claim.id);
    reader.required("statement", claim.statement);
    reader.required("place", claim.place);
    reader.required("study", claim.study);
    reader.required("cost_minutes", claim.cost_minutes);
    reader.required("rule", rule);
    reader.optional("metrics", claim.metrics);
    reader.optional("deformer", claim.deformer);
    claim.of = read_key(reader, file);
    reader.optional("subject", claim.subject);
    reader.optional("each", claim.each);
    reader.optional("compared", claim.compared);
    reader.optional("reported", claim.reported);
    reader.optional("orders", claim.orders);
    claim.bounds = read_bounds(reader, file);
    reader.optional("iterations", claim.iterations);
    reader.optional("expected_pct", claim.expected);
    reader.optional("low_pct", claim.low);
    reader.optional("high_pct", claim.high);
    reader.optional("low", claim.low);
    reader.optional("high", claim.high);
    reader.optional("share", claim.share);
    reader.optional("part", claim.part);
    reader.optional("level", claim.level);
    reader.optional("reason", claim.reason);
    reader.optional("formulae", claim.formulae);
    reader.require_nothing_unknown();
    if (!rules.contains(rule)) reader.refuse("rule", "expected share_within, mean_within, measured, printed or untestable");
    claim.rule = rules.at(rule);
    require_judgeable(claim, reader);
    return claim;
}

// [quantity] NAME = { title, unit }
std::vector<Quantity> read_quantities(const toml::table& document, const std::string& file)
{
    std::vector<Quantity> quantities;
    const toml::node* node = document.get("quantity");
    if (!node) return quantities;
    if (!node->is_table()) throw InputError(file, static_cast<int>(node->source().begin.line), "quantity", "", "expected a table");
    for (const auto& [name, entry] : *node->as_table()) {
        if (!entry.is_table())
            throw InputError(file, static_cast<int>(entry.source().begin.line), std::string(name.str()), "", "expected { title, unit }");
        TomlKeys keys(*entry.as_table(), file, "quantity");
        Quantity& quantity = quantities.emplace_back();
        quantity.name = name.str();
        keys.required("title", quantity.title);
        keys.required("unit", quantity.unit);
        keys.require_nothing_unknown();
    }
    return quantities;
}

std::vector<Quantity> named_by(const Claim& claim, const std::vector<Quantity>& quantities)
{
    std::vector<Quantity> named;
    for (const auto& names : {claim.metrics, claim.reported})
        for (const std::string& name : names)
            for (const Quantity& quantity : quantities)
                if (quantity.name == name) named.push_back(quantity);
    return named;
}

}  // namespace

std::vector<Claim> parse_claims(const std::string& text, const std::string& file)
{
    const toml::table document = parse_toml_document(text, file, {"check", "claim", "quantity"});
    const std::vector<const toml::table*> tables = toml_tables(document, "claim", file);
    if (tables.empty()) throw InputError(file, 0, "claim", "", "expected [[claim]] tables");
    const std::vector<Quantity> quantities = read_quantities(document, file);
    std::vector<Claim> claims;
    for (const toml::table* table : tables) {
        claims.push_back(read_claim(*table, file));
        claims.back().quantities = named_by(claims.back(), quantities);
        const auto same = [&](const Claim& other) { return other.id == claims.back().id; };
        if (std::count_if(claims.begin(), claims.end(), same) > 1)
            throw InputError(file, static_cast<int>(table->source().begin.line), "id", claims.back().id, "expected each claim once");
    }
    return claims;
}

const char* name_of(ClaimRule rule)
{
    return std::find_if(rules.begin(), rules.end(), [&](const auto& entry) { return entry.second == rule; })->first.c_str();
}

}  // namespace analysis
