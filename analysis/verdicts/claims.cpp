#include "analysis/verdicts/claims.hpp"

#include "analysis/records/toml_keys.hpp"
#include "analysis/verdicts/headline.hpp"

#include <algorithm>
#include <set>

namespace analysis {
namespace {

using pbs::InputError;

template <typename Enum>
using Names = std::vector<std::pair<const char*, Enum>>;

const Names<ClaimRule> rules = {{"cases", ClaimRule::cases},
                                {"single", ClaimRule::single},
                                {"printed", ClaimRule::printed},
                                {"definition", ClaimRule::definition},
                                {"untestable", ClaimRule::untestable}};
const Names<Role> roles = {{"claimed", Role::claimed},
                           {"negative_control", Role::negative_control},
                           {"positive_control", Role::positive_control},
                           {"comparison", Role::comparison}};
const Names<Mean> means = {{"arithmetic", Mean::arithmetic}, {"geometric", Mean::geometric}};

template <typename Enum>
void read_name(TomlKeys& keys, const char* key, const Names<Enum>& names, const char* rule, Enum& value)
{
    std::string text;
    keys.optional(key, text);
    if (!keys.has(key)) return;
    const auto found = std::ranges::find_if(names, [&](const auto& entry) { return entry.first == text; });
    if (found == names.end()) keys.refuse(key, rule);
    value = found->second;
}

// { deformer = "pbs", ... }
CaseKey read_key(const toml::table& table, const std::string& file)
{
    TomlKeys fields(table, file, "key");
    CaseKey key;
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

CaseKey read_key(TomlKeys& keys, const char* name, const std::string& file)
{
    keys.mark_read(name);
    const toml::node* node = keys.node(name);
    if (!node) return {};
    if (!node->is_table()) keys.refuse(name, "expected { field = value }");
    return read_key(*node->as_table(), file);
}

// Calls `read` with each table of a list; nothing for a key that is missing.
template <typename Read>
void read_each(TomlKeys& keys, const char* name, const char* rule, Read&& read)
{
    keys.mark_read(name);
    const toml::node* node = keys.node(name);
    if (!node) return;
    if (!node->is_array()) keys.refuse(name, rule);
    for (const toml::node& entry : *node->as_array()) {
        if (!entry.is_table()) keys.refuse(name, rule);
        read(*entry.as_table());
    }
}

std::vector<Threshold> read_thresholds(TomlKeys& claim, const std::string& file)
{
    std::vector<Threshold> thresholds;
    read_each(claim, "thresholds", "expected a list of { low, high, of }", [&](const toml::table& table) {
        TomlKeys keys(table, file, "threshold");
        Threshold& threshold = thresholds.emplace_back();
        keys.optional("quantity", threshold.quantity);
        keys.optional("low", threshold.low);
        keys.optional("high", threshold.high);
        threshold.of = read_key(keys, "of", file);
        keys.require_nothing_unknown();
        if (!(threshold.low <= threshold.high)) keys.refuse("low", "expected low <= high");
        if (!keys.has("low") && !keys.has("high")) keys.refuse("low", "expected low, high or both");
    });
    return thresholds;
}

// What an entry of `controls` or `compared` does not state is that of the claim.
void read_others(TomlKeys& claim, const char* list, const std::string& file, Claim& to)
{
    read_each(claim, list, "expected a list of { name, of }", [&](const toml::table& table) {
        TomlKeys keys(table, file, "control");
        Selection& other = to.others.emplace_back();
        other.role = Role::comparison;
        keys.required("name", other.name);
        read_name(keys, "role", roles, "expected negative_control or positive_control", other.role);
        keys.optional("quantities", other.quantities);
        if (!keys.has("quantities")) other.quantities = to.own.quantities;
        other.of = read_key(keys, "of", file);
        other.over = keys.has("over") ? read_key(keys, "over", file) : to.own.over;
        other.thresholds = read_thresholds(keys, file);
        if (other.thresholds.empty()) other.thresholds = to.own.thresholds;
        keys.require_nothing_unknown();
        const bool is_control = other.role == Role::negative_control || other.role == Role::positive_control;
        if (is_control != (std::string(list) == "controls"))
            keys.refuse("role", "expected negative_control or positive_control in controls, and none in compared");
    });
}

bool is_field_of_a_case(const std::string& name)
{
    return name == "quantity" || case_key_field(name);
}

void require_judgeable(const Claim& claim, const TomlKeys& reader)
{
    const bool by_cases = claim.rule == ClaimRule::cases, measured = by_cases || claim.rule == ClaimRule::single;
    if (measured && claim.own.quantities.empty()) reader.refuse("quantities", "expected at least one");
    if (measured && claim.own.thresholds.empty()) reader.refuse("thresholds", "missing in this claim");
    if (measured && claim.source.empty()) reader.refuse("source", "expected where the threshold comes from");
    if (by_cases && claim.case_fields.empty()) reader.refuse("case_fields", "expected the fields that make a case");
    for (const std::string& field : claim.case_fields)
        if (!is_field_of_a_case(field))
            reader.refuse("case_fields", field + ": expected fields of a key, as body or joint, or quantity");
    if (!(claim.no_effect >= 0.0 && claim.no_effect < 1.0)) reader.refuse("no_effect", "expected 0 <= no_effect < 1");
    const auto is_negative = [](const Selection& selection) { return selection.role == Role::negative_control; };
    if (by_cases && claim.no_effect == 0.0 && std::ranges::none_of(claim.others, is_negative))
        reader.refuse("controls", "expected a negative control, or no_effect");
    const auto is_selecting = [&](const Selection& selection) {
        return selection.name == claim.selected_by && is_negative(selection);
    };
    if (!claim.selected_by.empty() && std::ranges::none_of(claim.others, is_selecting))
        reader.refuse("selected_by", "expected the name of a negative control");
    if (const std::string fault = short_name_fault(claim); !fault.empty()) reader.refuse("short", fault);
    if (const std::string fault = headline_fault(claim); !fault.empty()) reader.refuse("headline", fault);
    const bool untested = claim.rule == ClaimRule::untestable || claim.rule == ClaimRule::definition;
    if (untested && claim.reason.empty()) reader.refuse("reason", "missing in this claim");
}

Claim read_claim(const toml::table& table, const std::string& file)
{
    TomlKeys reader(table, file, "claim");
    Claim claim;
    reader.required("id", claim.id);
    reader.required("statement", claim.statement);
    reader.required("short", claim.short_name);
    reader.required("headline", claim.headline);
    reader.required("place", claim.place);
    reader.required("study", claim.study);
    reader.required("cost_minutes", claim.cost_minutes);
    if (!reader.has("rule")) reader.refuse("rule", "missing in this claim");
    read_name(reader, "rule", rules, "expected cases, single, printed, definition or untestable", claim.rule);
    claim.own.name = claim.id;
    reader.optional("quantities", claim.own.quantities);
    claim.own.of = read_key(reader, "of", file);
    claim.own.over = read_key(reader, "over", file);
    claim.own.thresholds = read_thresholds(reader, file);
    reader.optional("case_fields", claim.case_fields);
    read_name(reader, "mean", means, "expected arithmetic or geometric", claim.mean);
    reader.optional("source", claim.source);
    reader.optional("range", claim.range);
    read_others(reader, "controls", file, claim);
    read_others(reader, "compared", file, claim);
    reader.optional("selected_by", claim.selected_by);
    reader.optional("no_effect", claim.no_effect);
    read_each(reader, "held_out", "expected a list of { field = value }",
              [&](const toml::table& key) { claim.held_out.push_back(read_key(key, file)); });
    reader.optional("thresholds_fixed_at", claim.thresholds_fixed_at);
    reader.optional("fixed_at", claim.fixed_at);
    reader.optional("reason", claim.reason);
    reader.optional("formulae", claim.formulae);
    reader.require_nothing_unknown();
    require_judgeable(claim, reader);
    return claim;
}

// [quantity] NAME = { title, unit }
std::vector<Quantity> read_quantities(const toml::table& document, const std::string& file)
{
    std::vector<Quantity> quantities;
    const toml::node* node = document.get("quantity");
    if (!node) return quantities;
    if (!node->is_table())
        throw InputError(file, static_cast<int>(node->source().begin.line), "quantity", "", "expected a table");
    for (const auto& [name, entry] : *node->as_table()) {
        if (!entry.is_table())
            throw InputError(file, static_cast<int>(entry.source().begin.line), std::string(name.str()), "",
                             "expected { title, unit }");
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
    std::set<std::string> names(claim.own.quantities.begin(), claim.own.quantities.end());
    for (const Selection& other : claim.others) names.insert(other.quantities.begin(), other.quantities.end());
    std::vector<Quantity> named;
    std::ranges::copy_if(quantities, std::back_inserter(named),
                         [&](const Quantity& quantity) { return names.contains(quantity.name); });
    return named;
}

template <typename Enum>
const char* name_in(const Names<Enum>& names, Enum value)
{
    return std::ranges::find(names, value, &std::pair<const char*, Enum>::second)->first;
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
        if (std::ranges::count(claims, claims.back().id, &Claim::id) > 1)
            throw InputError(file, static_cast<int>(table->source().begin.line), "id", claims.back().id,
                             "expected each claim once");
    }
    return claims;
}

const char* name_of(ClaimRule rule)
{
    return name_in(rules, rule);
}

const char* name_of(Role role)
{
    return name_in(roles, role);
}

}  // namespace analysis
