#include "analysis/claims.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
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

// One [[claim]] table, read key by key; what is left unread is unknown.
class ClaimReader {
public:
    ClaimReader(const toml::table& table, const std::string& file) : table_(table), file_(file) {}

    template <typename Value>
    void required(const char* key, Value& value)
    {
        if (!table_.contains(key)) throw InputError(file_, line(table_), key, "", "missing in this claim");
        optional(key, value);
    }

    template <typename Value>
    void optional(const char* key, Value& value)
    {
        read_.insert(key);
        const toml::node* node = table_.get(key);
        if (!node) return;
        const auto found = node->value<Value>();
        if (!found) refuse(key, "has the wrong type");
        value = *found;
    }

    bool has(const char* key) const { return table_.contains(key); }

    void optional(const char* key, std::vector<std::string>& values)
    {
        read_.insert(key);
        const toml::node* node = table_.get(key);
        if (!node) return;
        if (!node->is_array()) refuse(key, "expected a list");
        for (const toml::node& entry : *node->as_array()) {
            if (!entry.is_string()) refuse(key, "expected texts");
            values.push_back(entry.value<std::string>().value());
        }
    }

    void optional(const char* key, std::vector<QuantityBound>& bounds)
    {
        read_.insert(key);
        const toml::node* node = table_.get(key);
        if (!node) return;
        if (!node->is_array()) refuse(key, "expected a list");
        for (const toml::node& entry : *node->as_array()) {
            if (!entry.is_table()) refuse(key, "expected { quantity, low, high }");
            ClaimReader reader(*entry.as_table(), file_);
            QuantityBound& bound = bounds.emplace_back();
            reader.required("quantity", bound.quantity);
            reader.optional("low", bound.low);
            reader.optional("high", bound.high);
            reader.require_nothing_unknown();
            if (!(bound.low <= bound.high)) reader.refuse("low", "expected low <= high");
        }
    }

    void require_nothing_unknown() const
    {
        for (const auto& [key, node] : table_)
            if (!read_.contains(std::string(key.str())))
                throw InputError(file_, line(node), std::string(key.str()), "", "unknown key of a claim");
    }

    [[noreturn]] void refuse(const char* key, const std::string& rule) const
    {
        const toml::node* node = table_.get(key);
        throw InputError(file_, node ? line(*node) : line(table_), key, "", rule);
    }

private:
    static int line(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

    const toml::table& table_;
    const std::string& file_;
    std::set<std::string> read_;
};

void require_bounds(const Claim& claim, const ClaimReader& reader)
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

void require_judgeable(const Claim& claim, const ClaimReader& reader)
{
    const bool by_records = claim.rule == ClaimRule::share_within || claim.rule == ClaimRule::mean_within;
    if (by_records && claim.metrics.empty()) reader.refuse("metrics", "expected at least one");
    const bool measured = claim.rule == ClaimRule::measured;
    if (measured && claim.metrics.empty()) reader.refuse("metrics", "expected at least one");
    if (measured && !(claim.low <= claim.high)) reader.refuse("low", "expected low <= high");
    if (measured) require_bounds(claim, reader);
    for (const auto& metric : claim.metrics)
        if (!measured && !measurable.contains(metric))
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
    ClaimReader reader(table, file);
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
    reader.optional("beside", claim.beside);
    reader.optional("orders", claim.orders);
    reader.optional("bounds", claim.bounds);
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
    reader.require_nothing_unknown();
    if (!rules.contains(rule)) reader.refuse("rule", "expected share_within, mean_within, measured, printed or untestable");
    claim.rule = rules.at(rule);
    require_judgeable(claim, reader);
    return claim;
}

toml::table parse_toml(const std::string& text, const std::string& file)
{
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        throw InputError(file, static_cast<int>(error.source().begin.line), "", "", std::string(error.description()));
    }
}

}  // namespace

std::vector<Claim> parse_claims(const std::string& text, const std::string& file)
{
    const toml::table document = parse_toml(text, file);
    for (const auto& [key, node] : document)
        if (key.str() != "schema" && key.str() != "claim")
            throw InputError(file, static_cast<int>(node.source().begin.line), std::string(key.str()), "",
                             "unknown key: expected schema or claim");
    if (document["schema"].value_or(0) != 1) throw InputError(file, 0, "schema", "", "expected 1");
    const toml::array* tables = document["claim"].as_array();
    if (!tables || !tables->is_homogeneous(toml::node_type::table)) throw InputError(file, 0, "claim", "", "expected [[claim]] tables");
    std::vector<Claim> claims;
    for (const toml::node& node : *tables) {
        claims.push_back(read_claim(*node.as_table(), file));
        const auto same = [&](const Claim& other) { return other.id == claims.back().id; };
        if (std::count_if(claims.begin(), claims.end(), same) > 1)
            throw InputError(file, static_cast<int>(node.source().begin.line), "id", claims.back().id, "expected each claim once");
    }
    return claims;
}

}  // namespace analysis
