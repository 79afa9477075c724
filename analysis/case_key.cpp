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
    const auto text = [](const char* name, std::string Key::*member, const char* label = "{}") {
        return CaseKeyField{name, label, member, nullptr};
    };
    const auto number = [](const char* name, std::optional<double> Key::*member, const char* label) {
        return CaseKeyField{name, label, nullptr, member};
    };
    static const std::vector<CaseKeyField> fields = {text("body", &Key::body),
                                                     text("motion", &Key::motion),
                                                     text("pose", &Key::pose),
                                                     text("joint", &Key::joint),
                                                     number("angle_deg", &Key::angle_deg, "{:.4g} deg"),
                                                     number("time_s", &Key::time_s, "at {:.4g} s"),
                                                     text("deformer", &Key::deformer),
                                                     text("variant", &Key::variant),
                                                     text("reference", &Key::reference, "reference {}"),
                                                     text("order", &Key::order),
                                                     text("precision", &Key::precision),
                                                     number("vertices", &Key::vertices, "{:.6g} vertices"),
                                                     number("vertices_to", &Key::vertices_to, "to {:.6g} vertices"),
                                                     number("k_stretch", &Key::k_stretch, "k_stretch {:.4g}"),
                                                     number("k_stretch_to", &Key::k_stretch_to, "to k_stretch {:.4g}"),
                                                     number("k_bind", &Key::k_bind, "k_bind {:.4g}"),
                                                     number("young_pa", &Key::young_pa, "{:.3g} Pa"),
                                                     text("masses", &Key::masses, "{} masses"),
                                                     number("iterations", &Key::iterations, "{:.4g} iterations"),
                                                     number("iterations_to", &Key::iterations_to, "to {:.4g} iterations"),
                                                     number("time_step_s", &Key::time_step_s, "step {:.4g} s"),
                                                     number("time_step_to_s", &Key::time_step_to_s, "to step {:.4g} s"),
                                                     text("constraint", &Key::constraint, "{} constraints"),
                                                     text("initial_guess", &Key::initial_guess, "from {}"),
                                                     text("tolerance", &Key::tolerance, "tolerance {}"),
                                                     text("load", &Key::load),
                                                     text("ladder", &Key::ladder),
                                                     text("factor", &Key::factor),
                                                     text("second_factor", &Key::second_factor, "and {}"),
                                                     text("model", &Key::model),
                                                     text("equation", &Key::equation, "Eq. {}"),
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
    std::vector<std::string> labels;
    for (const CaseKeyField& field : case_key_fields()) {
        if (!field.is_set(key)) continue;
        labels.push_back(field.text ? fmt::format(fmt::runtime(field.label), key.*field.text)
                                    : fmt::format(fmt::runtime(field.label), *(key.*field.number)));
    }
    return fmt::format("{}", fmt::join(labels, ", "));
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
