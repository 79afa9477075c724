#include "analysis/verdicts/case_record.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace analysis {

const std::vector<CaseKeyField>& case_key_fields()
{
    using enum CaseKeyField::Shown;
    static const std::vector<CaseKeyField> fields = {
        {"body", "", alone, &CaseKey::body},
        {"motion", "", alone, &CaseKey::motion},
        {"pose", "", alone, &CaseKey::pose},
        {"joint", "", alone, &CaseKey::joint},
        {"angle_deg", "deg", alone, nullptr, &CaseKey::angle_deg},
        {"time_s", "s", with_name, nullptr, &CaseKey::time_s},
        {"deformer", "", alone, &CaseKey::deformer},
        {"variant", "", alone, &CaseKey::variant},
        {"reference", "", with_name, &CaseKey::reference},
        {"order", "", alone, &CaseKey::order},
        {"precision", "", alone, &CaseKey::precision},
        {"vertices", "", with_name, nullptr, &CaseKey::vertices},
        {"vertices_to", "", as_end_of_range, nullptr, &CaseKey::vertices_to},
        {"k_stretch", "", with_name, nullptr, &CaseKey::k_stretch},
        {"k_stretch_to", "", as_end_of_range, nullptr, &CaseKey::k_stretch_to},
        {"k_bind", "", with_name, nullptr, &CaseKey::k_bind},
        {"young_pa", "Pa", with_name, nullptr, &CaseKey::young_pa},
        {"masses", "", with_name, &CaseKey::masses},
        {"iterations", "", with_name, nullptr, &CaseKey::iterations},
        {"iterations_to", "", as_end_of_range, nullptr, &CaseKey::iterations_to},
        {"time_step_s", "s", with_name, nullptr, &CaseKey::time_step_s},
        {"time_step_to_s", "s", as_end_of_range, nullptr, &CaseKey::time_step_to_s},
        {"constraint", "", with_name, &CaseKey::constraint},
        {"initial_guess", "", with_name, &CaseKey::initial_guess},
        {"tolerance", "", with_name, &CaseKey::tolerance},
        {"load", "", with_name, &CaseKey::load},
        {"ladder", "", with_name, &CaseKey::ladder},
        {"factor", "", with_name, &CaseKey::factor},
        {"second_factor", "", with_name, &CaseKey::second_factor},
        {"model", "", with_name, &CaseKey::model},
        {"equation", "", with_name, &CaseKey::equation},
        {"gradient_of", "", with_name, &CaseKey::gradient_of},
        {"reading", "", with_name, &CaseKey::reading}};
    return fields;
}

const CaseKeyField* case_key_field(const std::string& name)
{
    const auto& fields = case_key_fields();
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const CaseKeyField& field) { return field.name == name; });
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
    const std::vector<CaseKeyField>& all = case_key_fields();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string name = all[i].name, unit = all[i].unit;
        std::string value = value_text(all[i], key);
        if (value.empty() || all[i].shown == CaseKeyField::Shown::as_end_of_range) continue;
        if (i + 1 < all.size() && all[i + 1].shown == CaseKeyField::Shown::as_end_of_range && all[i + 1].is_set(key))
            value += " to " + value_text(all[i + 1], key);
        if (!unit.empty()) value += " " + unit;
        if (all[i].shown == CaseKeyField::Shown::with_name)
            value = name.substr(0, unit.empty() ? name.npos : name.rfind('_')) + " " + value;
        fields.push_back(value);
    }
    return fmt::format("{}", fmt::join(fields, ", "));
}

bool matches(const CaseKey& key, const CaseKey& wanted)
{
    return std::all_of(case_key_fields().begin(), case_key_fields().end(), [&](const CaseKeyField& field) {
        return !field.is_set(wanted) || value_text(field, key) == value_text(field, wanted);
    });
}

const Columns<CaseKey>& case_key_columns()
{
    static const Columns<CaseKey> columns = [] {
        Columns<CaseKey> all;
        for (const CaseKeyField& field : case_key_fields()) {
            if (field.text)
                all.emplace_back(field.name, field.text);
            else
                all.emplace_back(field.name, field.number);
            all.back().group = field.name;
        }
        return all;
    }();
    return columns;
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
        if (!field)
            throw pbs::InputError(file, 0, "of." + name, value.dump(),
                                  "expected a field of a key, as body, motion or joint");
        if (field->text ? !value.is_string() : !value.is_number())
            throw pbs::InputError(file, 0, "of." + name, value.dump(),
                                  field->text ? "expected a text" : "expected a number");
        if (field->text)
            key.*field->text = value.get<std::string>();
        else
            key.*field->number = value.get<double>();
    }
    return key;
}

namespace {

CaseRecord record_of(const CsvTable& frames, const std::string& run)
{
    const CsvTable::Row& first = frames[0];
    CaseRecord record{.scene = first.text("scene"),
                      .deformer = first.text("deformer"),
                      .variant = first.text("variant"),
                      .order = first.text("order"),
                      .precision = first.text("precision"),
                      .iterations = first.value<std::optional<int>>("iterations").value_or(0),
                      .run = run};
    for (const CsvTable::Row& row : frames) {
        if (record.iterations == 0 && frames.has_column("outcome") && row.text("outcome") == "not_converged") {
            ++record.frames_not_converged;
            continue;
        }
        record.frame.push_back(row.number("frame"));
        record.time_s.push_back(row.number("time_s"));
        record.volume_change_pct.push_back(row.number("volume_change_pct"));
        record.volume_abs_change_pct.push_back(row.number("volume_abs_change_pct"));
        record.inverted_tets.push_back(row.number("inverted_tets"));
        if (frames.has_column("angle_deg"))
            if (const auto angle_deg = row.number_or_nothing("angle_deg")) record.angle_deg.push_back(*angle_deg);
    }
    require_whole(record);
    return record;
}

const Columns<PrintedValue>& printed_columns()
{
    static const Columns<PrintedValue> columns =
        MEMBER_COLUMNS(PrintedValue, claim, quantity) + within(&PrintedValue::of, case_key_columns()) +
        Columns<PrintedValue>{{"printed", &PrintedValue::printed},
                              {"least", &PrintedValue::least},
                              column_with_empty(std::numeric_limits<double>::infinity(), "most", &PrintedValue::most)};
    return columns;
}

}  // namespace

std::vector<CaseRecord> case_records(const CsvTable& metrics, const std::string& run)
{
    std::vector<CaseRecord> records;
    for (const CsvTable& frames :
         metrics.groups({"scene", "deformer", "variant", "order", "precision", "iterations", "threads"}))
        records.push_back(record_of(frames, run));
    return records;
}

void require_whole(const CaseRecord& record)
{
    const std::size_t frames = record.frame.size();
    const bool angles_fit = record.angle_deg.empty() || record.angle_deg.size() == frames;
    if (record.time_s.size() != frames || record.volume_change_pct.size() != frames ||
        record.volume_abs_change_pct.size() != frames || record.inverted_tets.size() != frames || !angles_fit)
        throw pbs::InputError(record.run, 0, fmt::format("record of {} on {}", record.deformer, record.scene), "",
                              fmt::format("expected {} values in every series", frames));
}

std::vector<PrintedValue> printed_values(const std::string& csv)
{
    return rows_of(printed_columns(), read_csv(csv));
}

CsvTable printed_table(const std::vector<PrintedValue>& values)
{
    return table_of(used_columns(printed_columns(), values), values);
}

}  // namespace analysis
