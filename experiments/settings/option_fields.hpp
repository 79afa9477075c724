// The fields of a struct of options. Each is declared once, with its key in a scene, its default, range, unit and
// meaning, and its name in a record.
//   static const auto fields = OptionFields<pbs::XpbdOptions>("xpbd")
//                                  .add("young_pa", &pbs::XpbdOptions::young_pa,
//                                       {.unit = "Pa", .range = {above_zero}, .meaning = "..."})
//                                  .record("substeps", &pbs::XpbdOptions::substeps);
//   fields.keys()               the keys, for a schema; the defaults are those of pbs::XpbdOptions{}
//   fields.read(values, "xpbd") the options as a scene states them
//   fields.json(options)        all fields by name, for a record
// A member is a number, a bool, a text, a Vec3, a list of integers or texts, or an enumeration with option_names. It
// may belong to a base class of the options.
#pragma once

#include "experiments/settings/option_names.hpp"
#include "experiments/settings/scene_values.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace experiments {

// The number of members of a struct, to check that a declaration of its fields is complete.
//   static_assert(member_count<Jolt>() == 5);
// The struct must be an aggregate without base classes and without C arrays (std::array is allowed).

// Converts to a member of any type; only its type is used.
struct AnyMember {
    template <typename Member>
    operator Member() const;
};

template <typename Struct, std::size_t... indices>
constexpr bool takes_members(std::index_sequence<indices...>)
{
    return requires
    {
        Struct{(static_cast<void>(indices), AnyMember{})...};
    };
}

template <typename Struct, std::size_t count = 0>
constexpr std::size_t member_count()
{
    static_assert(std::is_aggregate_v<Struct>);
    if constexpr (takes_members<Struct>(std::make_index_sequence<count + 1>{}))
        return member_count<Struct, count + 1>();
    else
        return count;
}

// A value as JSON: an enumeration by its name, a struct by its to_json or to_json_of.
template <typename Value>
nlohmann::json option_json(const Value& value)
{
    if constexpr (std::is_enum_v<Value>)
        return name_of(value);
    else if constexpr (std::is_same_v<Value, pbs::Vec3>)
        return {value.x(), value.y(), value.z()};
    else if constexpr (requires { to_json(value); })
        return to_json(value);
    else if constexpr (requires { to_json_of(value); })
        return to_json_of(value);
    else
        return value;
}

template <typename Value>
nlohmann::json option_json(const std::vector<Value>& values)
{
    nlohmann::json list = nlohmann::json::array();
    for (const Value& value : values) list.push_back(option_json(value));
    return list;
}

template <typename Value>
constexpr KeyType key_type()
{
    if constexpr (std::is_same_v<Value, bool>)
        return KeyType::boolean;
    else if constexpr (std::is_same_v<Value, int>)
        return KeyType::integer;
    else if constexpr (std::is_same_v<Value, double>)
        return KeyType::number;
    else if constexpr (std::is_same_v<Value, pbs::Vec3>)
        return KeyType::vec3;
    else if constexpr (std::is_same_v<Value, std::vector<int>>)
        return KeyType::integers;
    else if constexpr (std::is_same_v<Value, std::vector<std::string>>)
        return KeyType::texts;
    else
        return KeyType::text;
}

template <typename Value>
Value read_option(const SceneValues& values, const std::string& path)
{
    if constexpr (std::is_enum_v<Value>)
        return option_of<Value>(values.text(path));
    else if constexpr (std::is_same_v<Value, pbs::Vec3>)
        return pbs::Vec3::Map(values.numbers(path).data());
    else
        return values.value(path).get<Value>();
}

struct FieldText {
    std::string unit = {};
    Range range = {};                       // of a number, or of each in a list
    std::vector<std::string> choices = {};  // of a text; those of an enumeration are its names
    bool is_stated = false;                 // every scene must state it, for there is no default
    std::string meaning = {};
};

template <typename Options>
class OptionFields {
public:
    using Reader = std::function<void(Options& options, const SceneValues& values, const std::string& path)>;
    using Writer = std::function<void(const Options& options, nlohmann::json& record)>;

    explicit OptionFields(std::string table, bool in_list = false)
        : table_(table), root_(std::move(table)), in_list_(in_list)
    {
    }

    // The fields that follow are in this table within the first one. They are read only if a scene has that table.
    OptionFields& in_table(const std::string& name)
    {
        table_ = root_ + "." + name;
        return *this;
    }

    template <typename Member, typename Owner>
    OptionFields& add(const std::string& name, Member Owner::*member, const FieldText& text)
    {
        recorded_members_[table_ + "." + name] = 1;
        SceneKey key = key_of(name, key_type<Member>(), text, option_json(Options{}.*member));
        if constexpr (std::is_enum_v<Member>) key.choices = names_of_options<Member>();
        return add(
            key,
            [member](Options& options, const SceneValues& values, const std::string& path) {
                options.*member = read_option<Member>(values, path);
            },
            [name, member](const Options& options, nlohmann::json& record) {
                record[name] = option_json(options.*member);
            });
    }

    // A key whose value is not stored in exactly one member. `write` records so many members.
    OptionFields& add(const std::string& name, KeyType type, const nlohmann::json& default_value, const FieldText& text,
                      Reader read, Writer write, std::size_t members = 1)
    {
        if (write) recorded_members_[table_ + "." + name] = members;
        return add(key_of(name, type, text, default_value), std::move(read), std::move(write));
    }

    // A key that other code reads.
    OptionFields& key(const std::string& name, KeyType type, const nlohmann::json& default_value, const FieldText& text)
    {
        return add(key_of(name, type, text, default_value), nullptr, nullptr);
    }

    // A key of an earlier release: for each of its values the keys of this table that replace it, as in --set.
    OptionFields& renamed(const std::string& name, std::map<std::string, std::vector<std::string>> now)
    {
        renamed_keys_.push_back({table_ + "." + name, std::move(now)});
        return *this;
    }

    // A member that only studies set, not scenes.
    template <typename Member, typename Owner>
    OptionFields& record(const std::string& name, Member Owner::*member)
    {
        recorded_members_[table_ + "." + name] = 1;
        return derived(name, [member](const Options& options) { return option_json(options.*member); });
    }

    // A value that results depend on and that is no member: a constant of the code, or a function of the members.
    OptionFields& derived(const std::string& name, std::function<nlohmann::json(const Options&)> value)
    {
        return add({}, nullptr,
                   [name, value](const Options& options, nlohmann::json& json) { json[name] = value(options); });
    }
    OptionFields& constant(const std::string& name, const nlohmann::json& value)
    {
        return derived(name, [value](const Options&) { return value; });
    }

    // std::logic_error unless each member is recorded, except for so many on which no result depends, such as the
    // number of threads. Settings of a study's run must be complete, for --resume compares them, and so must options of
    // deformers, except for structs with a base, whose members cannot be counted.
    const OptionFields& complete(std::size_t except = 0) const
    {
        std::size_t recorded = except;
        for (const auto& [name, members] : recorded_members_) recorded += members;
        if (recorded == member_count<Options>()) return *this;
        throw std::logic_error("settings " + root_ + ": " + std::to_string(recorded) + " of " +
                               std::to_string(member_count<Options>()) + " members are declared");
    }

    std::vector<SceneKey> keys() const
    {
        std::vector<SceneKey> keys;
        for (const Field& field : fields_)
            if (!field.key.name.empty()) keys.push_back(field.key);
        return keys;
    }

    const std::vector<RenamedKey>& renamed_keys() const { return renamed_keys_; }
    const std::string& table() const { return root_; }

    // `table`: the fields' own, or one of a list, e.g. fem.0.
    Options read(const SceneValues& values, const std::string& table) const
    {
        Options options;
        for (const Field& field : fields_) {
            const bool is_there = field.key.table == root_ || values.has_table(field.key.table);
            if (field.read && is_there) field.read(options, values, table + field.key.path().substr(root_.size()));
        }
        return options;
    }

    nlohmann::json json(const Options& options) const
    {
        nlohmann::json record = nlohmann::json::object();
        for (const Field& field : fields_)
            if (field.write) field.write(options, record);
        return record;
    }

private:
    struct Field {
        SceneKey key;  // an empty name: the field has no key
        Reader read;
        Writer write;
    };

    OptionFields& add(SceneKey key, Reader read, Writer write)
    {
        fields_.push_back({std::move(key), std::move(read), std::move(write)});
        return *this;
    }

    SceneKey key_of(const std::string& name, KeyType type, const FieldText& text,
                    const nlohmann::json& default_value) const
    {
        return {.table = table_,
                .name = name,
                .type = type,
                .default_json = text.is_stated ? "" : default_text(default_value),
                .unit = text.unit,
                .range = text.range,
                .choices = text.choices,
                .meaning = text.meaning,
                .in_list = in_list_};
    }

    std::string table_, root_;
    bool in_list_;
    std::map<std::string, std::size_t> recorded_members_;  // by the field that records them
    std::vector<Field> fields_;
    std::vector<RenamedKey> renamed_keys_;
};

}  // namespace experiments
