// The members of a struct, and copies of the struct with one of them changed.
//   for_each_change(JoltCase{...}, [](const JoltCase& changed, const std::string& what) { ... });
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"

#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace test_support {

#define PBS_TIE_MEMBERS(number, ...)  \
    if constexpr (count == number) {  \
        auto& [__VA_ARGS__] = of;     \
        return std::tie(__VA_ARGS__); \
    }

// References to all members, in order. A struct with another number of members needs a further line.
template <typename Struct>
auto members_of(Struct& of)
{
    constexpr std::size_t count = experiments::member_count<std::remove_const_t<Struct>>();
    PBS_TIE_MEMBERS(1, a);
    PBS_TIE_MEMBERS(2, a, b);
    PBS_TIE_MEMBERS(3, a, b, c);
    PBS_TIE_MEMBERS(4, a, b, c, d);
    PBS_TIE_MEMBERS(5, a, b, c, d, e);
    PBS_TIE_MEMBERS(6, a, b, c, d, e, f);
    PBS_TIE_MEMBERS(7, a, b, c, d, e, f, g);
    PBS_TIE_MEMBERS(8, a, b, c, d, e, f, g, h);
    PBS_TIE_MEMBERS(10, a, b, c, d, e, f, g, h, i, j);
    PBS_TIE_MEMBERS(11, a, b, c, d, e, f, g, h, i, j, k);
    PBS_TIE_MEMBERS(12, a, b, c, d, e, f, g, h, i, j, k, l);
    PBS_TIE_MEMBERS(13, a, b, c, d, e, f, g, h, i, j, k, l, m);
    PBS_TIE_MEMBERS(16, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p);
    PBS_TIE_MEMBERS(18, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r);
    PBS_TIE_MEMBERS(19, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s);
    PBS_TIE_MEMBERS(22, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v);
    PBS_TIE_MEMBERS(24, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x);
    PBS_TIE_MEMBERS(26, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z);
}

#undef PBS_TIE_MEMBERS

template <typename Value>
inline constexpr bool is_vector = false;
template <typename Value>
inline constexpr bool is_vector<std::vector<Value>> = true;
template <typename Value>
inline constexpr bool is_optional = false;
template <typename Value>
inline constexpr bool is_optional<std::optional<Value>> = true;

template <typename Struct, typename Visit>
void for_each_change(const Struct& of, const Visit& visit);

// Values that differ from the given one, each in one way.
template <typename Value, typename Visit>
void for_each_other(const Value& value, const Visit& visit)
{
    if constexpr (std::is_same_v<Value, bool>) {
        visit(!value, "");
    } else if constexpr (std::is_arithmetic_v<Value>) {
        visit(static_cast<Value>(value + 1), "");
    } else if constexpr (std::is_same_v<Value, std::string>) {
        visit(value + "x", "");
    } else if constexpr (std::is_enum_v<Value>) {
        for (const auto& [other, name] : experiments::OptionNames<Value>::table)
            if (other != value) visit(other, name);
    } else if constexpr (std::is_same_v<Value, pbs::Vec3>) {
        visit(Value(value + pbs::Vec3::UnitZ()), "");
    } else if constexpr (std::is_same_v<Value, experiments::Scene>) {
        Value other = value;
        other.resolved["character"]["vertices"] = 4321;
        visit(other, "vertices");
        if (!value.deformers.empty())
            for_each_other(value.deformers.front(), [&](const auto& deformer, const std::string& what) {
                other = value;
                other.deformers.front() = deformer;
                visit(other, "deformer " + what);
            });
    } else if constexpr (std::is_same_v<Value, experiments::DeformerSpec>) {
        Value other = value;
        other.label += "x";
        visit(other, "label");
        if (!experiments::options_if<pbs::PbsOptions>(value)) return;
        other = value;
        ++experiments::options_of<pbs::PbsOptions>(other).iterations;
        visit(other, "iterations");
    } else if constexpr (std::is_same_v<Value, analysis::CaseKey>) {
        for (const analysis::CaseKeyField& field : analysis::case_key_fields()) {
            Value other = value;
            if (field.text)
                other.*field.text += "x";
            else
                other.*field.number = (value.*field.number).value_or(0.0) + 1.0;
            visit(other, field.name);
        }
    } else if constexpr (is_optional<Value>) {
        visit(value ? Value() : Value(std::in_place), "");
    } else if constexpr (is_vector<Value>) {
        Value other = value;
        other.push_back(value.empty() ? typename Value::value_type() : value.front());
        visit(other, "one more");
        if (!value.empty())
            for_each_other(value.front(), [&](const auto& first, const std::string& what) {
                other = value;
                other.front() = first;
                visit(other, "first " + what);
            });
    } else {
        for_each_change(value, visit);
    }
}

// Visits the struct with each member changed in turn and the others unchanged. If a member is a struct, each of its own members is changed
// in turn. visit is called with the changed struct and a description of the change.
template <typename Struct, typename Visit>
void for_each_change(const Struct& of, const Visit& visit)
{
    const auto change = [&]<std::size_t index>() {
        for_each_other(std::get<index>(members_of(of)), [&](const auto& value, const std::string& what) {
            Struct changed = of;
            std::get<index>(members_of(changed)) = value;
            visit(changed, "member " + std::to_string(index + 1) + (what.empty() ? "" : ", " + what));
        });
    };
    [&]<std::size_t... indices>(std::index_sequence<indices...>)
    {
        (change.template operator()<indices>(), ...);
    }
    (std::make_index_sequence<experiments::member_count<Struct>()>{});
}

}  // namespace test_support
