#include "analysis/case_key.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace analysis {

const std::vector<CaseKeyField>& case_key_fields()
{
    using Key = CaseKey;
    const auto text = [](const char* name, std::string Key::*member) { return CaseKeyField{name, false, member, nullptr}; };
    const auto named = [](const char* name, std::string Key::*member) { return CaseKeyField{name, true, member, nullptr}; };
    const auto number = [](const char* name, std::optional<double> Key::*member) { return CaseKeyField{name, true, nullptr, member}; };
    static const std::vector<CaseKeyField> fields = {text("body", &Key::body),
                                                     text("motion", &Key::motion),
                                                     text("pose", &Key::pose),
                                                     text("joint", &Key::joint),
                                                     number("angle_deg", &Key::angle_deg),
                                                     number("time_s", &Key::time_s),
                                                     text("deformer", &Key::deformer),
                                                     text("variant", &Key::variant),
                                                     named("reference", &Key::reference),
                                                     text("order", &Key::order),
                                                     text("precision", &Key::precision),
                                                     number("vertices", &Key::vertices),
                                                     number("vertices_to", &Key::vertices_to),
                                                     number("k_stretch", &Key::k_stretch),
                                                     number("k_stretch_to", &Key::k_stretch_to),
                                                     number("k_bind", &Key::k_bind),
                                                     number("young_pa", &Key::young_pa),
                                                     named("masses", &Key::masses),
                                                     number("iterations", &Key::iterations),
                                                     number("iterations_to", &Key::iterations_to),
                                                     number("time_step_s", &Key::time_step_s),
                                                     number("time_step_to_s", &Key::time_step_to_s),
                                                     named("constraint", &Key::constraint),
                                                     named("initial_guess", &Key::initial_guess),
                                                     named("tolerance", &Key::tolerance),
                                                     text("load", &Key::load),
                                                     text("ladder", &Key::ladder),
                                                     text("factor", &Key::factor),
                                                     named("second_factor", &Key::second_factor),
                                                     text("model", &Key::model),
                                                     named("equation", &Key::equation),
                                                     text("gradient_of", &Key::gradient_of),
                                                     text("reading", &Key::reading)};
    return fields;
}

const CaseKeyField* case_key_field(const std::string& name)
{
    const auto& fields = case_key_fields();
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const CaseKeyField& field) { return field.name == name; });
    return found == fields.end() ? nullptr : &*found;
}

std::string value_text(const CaseKeyField& field, const CaseKey& key)
{
    if (!field.is_set(key)) return "";
    return field.text ? key.*field.text : number_text(*(key.*field.number));
}

std::string text_of(const CaseKey& key)
{
    std::vector<std::string> fields;
    for (const CaseKeyField& field : case_key_fields())
        if (field.is_set(key)) fields.push_back((field.is_named ? field.name + std::string(" ") : "") + value_text(field, key));
    return fmt::format("{}", fmt::join(fields, ", "));
}

bool matches(const CaseKey& key, const CaseKey& wanted)
{
    return std::all_of(case_key_fields().begin(), case_key_fields().end(), [&](const CaseKeyField& field) {
        return !field.is_set(wanted) || value_text(field, key) == value_text(field, wanted);
    });
}

std::vector<const CaseKeyField*> used_fields(const std::vector<const CaseKey*>& keys)
{
    std::vector<const CaseKeyField*> used;
    for (const CaseKeyField& field : case_key_fields())
        if (std::any_of(keys.begin(), keys.end(), [&](const CaseKey* key) { return field.is_set(*key); })) used.push_back(&field);
    return used;
}

CsvTable::Cell cell_of(const CaseKeyField& field, const CaseKey& key)
{
    if (!field.is_set(key)) return std::nullopt;
    if (field.text) return key.*field.text;
    return *(key.*field.number);
}

CaseKey case_key(const CsvTable& table, int row)
{
    CaseKey key;
    for (const CaseKeyField& field : case_key_fields()) {
        if (!table.has_column(field.name)) continue;
        if (field.text)
            key.*field.text = table.text_at(row, field.name);
        else
            key.*field.number = table.number_or_nothing(row, field.name);
    }
    return key;
}

nlohmann::json to_json_of(const CaseKey& key)
{
    nlohmann::json object = nlohmann::json::object();
    for (const CaseKeyField& field : case_key_fields()) {
        if (!field.is_set(key)) continue;
        if (field.text)
            object[field.name] = key.*field.text;
        else
            object[field.name] = *(key.*field.number);
    }
    return object;
}

CaseKey case_key(const nlohmann::json& object, const std::string& file)
{
    if (!object.is_object()) throw pbs::InputError(file, 0, "of", object.dump(), "expected an object");
    CaseKey key;
    for (const auto& [name, value] : object.items()) {
        const CaseKeyField* field = case_key_field(name);
        if (!field) throw pbs::InputError(file, 0, "of." + name, value.dump(), "expected a field of a key, as body, motion or joint");
        if (field->text ? !value.is_string() : !value.is_number())
            throw pbs::InputError(file, 0, "of." + name, value.dump(), field->text ? "expected a text" : "expected a number");
        if (field->text)
            key.*field->text = value.get<std::string>();
        else
            key.*field->number = value.get<double>();
    }
    return key;
}

}  // namespace analysis
