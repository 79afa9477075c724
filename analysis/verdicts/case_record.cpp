#include "analysis/verdicts/case_record.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <map>
#include <tuple>

namespace analysis {

const std::vector<CaseKeyField>& case_key_fields()
{
    using Key = CaseKey;
    using Text = std::string Key::*;
    using Number = std::optional<double> Key::*;
    using enum CaseKeyField::Shown;
    const auto text = [](const char* name, Text member, const char* meaning, CaseKeyField::Shown shown = with_name) {
        return CaseKeyField{name, "", meaning, shown, member, nullptr};
    };
    const auto number = [](const char* name, Number member, const char* unit, const char* meaning, CaseKeyField::Shown shown = with_name) {
        return CaseKeyField{name, unit, meaning, shown, nullptr, member};
    };
    static const std::vector<CaseKeyField> fields = {
        text("body", &Key::body, "name of the body: limb, bar, ring, human, man, lady, frankie, or a character of the user's", alone),
        text("motion", &Key::motion, "twist, bend, or the name of a clip such as 01_01", alone),
        text("pose", &Key::pose, "pose in a clip: crouch, landing, in_the_air", alone),
        text("joint", &Key::joint, "the names of the joint's two bones, as in upper|forearm", alone),
        number("angle_deg", &Key::angle_deg, "deg", "angle of a joint that is twisted or bent", alone),
        number("time_s", &Key::time_s, "s", "time in the clip"),
        text("deformer", &Key::deformer, "the deformer that is measured", alone),
        text("variant", &Key::variant, "its variant, as jiggle", alone),
        text("reference", &Key::reference, "the deformer that the value is compared with"),
        text("order", &Key::order, "order of projection", alone),
        text("precision", &Key::precision, "f32 or f64", alone),
        number("vertices", &Key::vertices, "", "size of the mesh; of a ratio over a range, its first setting"),
        number("vertices_to", &Key::vertices_to, "", "last setting of the range", as_end_of_range),
        number("k_stretch", &Key::k_stretch, "", "stiffness of the stretch constraints; of a range, its first setting"),
        number("k_stretch_to", &Key::k_stretch_to, "", "last setting of the range", as_end_of_range),
        number("k_bind", &Key::k_bind, "", "stiffness of the bind constraints"),
        number("young_pa", &Key::young_pa, "Pa", "Young's modulus"),
        text("masses", &Key::masses, "how the particles' masses are set"),
        number("iterations", &Key::iterations, "", "iterations per step; of a range, its first setting"),
        number("iterations_to", &Key::iterations_to, "", "last setting of the range", as_end_of_range),
        number("time_step_s", &Key::time_step_s, "s", "time step; of a range, its first setting"),
        number("time_step_to_s", &Key::time_step_to_s, "s", "last setting of the range", as_end_of_range),
        text("constraint", &Key::constraint, "stretch, volume, bind"),
        text("initial_guess", &Key::initial_guess, "previous_frame, rest_pose, rigid_bind; of controls: lbs, random"),
        text("tolerance", &Key::tolerance, "residual: within 5 % of its floor; volume: absolute change within 0.5 %"),
        text("load", &Key::load, "load of a stiffness test"),
        text("ladder", &Key::ladder, "how its mesh sizes are made, if not as wanted"),
        text("factor", &Key::factor, "the parameter that a sweep of the stability study varies"),
        text("second_factor", &Key::second_factor, "the second parameter that a map varies"),
        text("model", &Key::model, "a row of Table 1 in the paper"),
        text("equation", &Key::equation, "an equation of the paper"),
        text("gradient_of", &Key::gradient_of, "a particle p1 to p4"),
        text("reading", &Key::reading, "as_printed, relative_to_p1, derived_gradients")};
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
                all.emplace_back(field.name, field.text, field.unit, field.meaning);
            else
                all.emplace_back(field.name, field.number, field.unit, field.meaning);
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

namespace {

// The columns of metrics.csv that identify the case and the frame of a row, and those that are judged. The file has further columns.
struct MetricsRow {
    std::string scene, deformer, variant, order, precision;
    std::optional<int> iterations;
    std::string threads, outcome;
    double frame = 0.0, time_s = 0.0, volume_change_pct = 0.0, volume_abs_change_pct = 0.0, inverted_tets = 0.0;
    std::optional<double> angle_deg;
};

const Columns<MetricsRow>& metrics_columns()
{
    static const Columns<MetricsRow> columns =
        Columns<MetricsRow>{{"scene", &MetricsRow::scene, "", "name of the scene"},
                            {"deformer", &MetricsRow::deformer, "", "name of the deformer"},
                            {"variant", &MetricsRow::variant, "", "its variant"},
                            {"order", &MetricsRow::order, "", "order of projection"},
                            {"precision", &MetricsRow::precision, "", "f32 or f64"},
                            {"iterations", &MetricsRow::iterations, "", "iterations per step"},
                            {"threads", &MetricsRow::threads, "", "number of threads"},
                            {"frame", &MetricsRow::frame, "", "number of the frame, from 0"},
                            {"time_s", &MetricsRow::time_s, "s", "time in the motion"},
                            {"volume_change_pct", &MetricsRow::volume_change_pct, "%", "signed change of the whole volume"},
                            {"volume_abs_change_pct", &MetricsRow::volume_abs_change_pct, "%", "sum of the absolute changes of each tet"},
                            {"inverted_tets", &MetricsRow::inverted_tets, "", "number of inverted tets"}} +
        optional(Columns<MetricsRow>{{"angle_deg", &MetricsRow::angle_deg, "deg", "angle of the joint, in a sweep"},
                                     {"outcome", &MetricsRow::outcome, "", "of the frame"}});
    return columns;
}

auto case_of(const MetricsRow& row)
{
    return std::tie(row.scene, row.deformer, row.variant, row.order, row.precision, row.iterations, row.threads);
}

CaseRecord empty_record(const MetricsRow& row, const std::string& run)
{
    CaseRecord record;
    record.scene = row.scene;
    record.deformer = row.deformer;
    record.variant = row.variant;
    record.order = row.order;
    record.precision = row.precision;
    record.iterations = row.iterations.value_or(0);
    record.run = run;
    return record;
}

void add_frame(CaseRecord& record, const MetricsRow& row)
{
    record.frame.push_back(row.frame);
    record.time_s.push_back(row.time_s);
    record.volume_change_pct.push_back(row.volume_change_pct);
    record.volume_abs_change_pct.push_back(row.volume_abs_change_pct);
    record.inverted_tets.push_back(row.inverted_tets);
    if (row.angle_deg) record.angle_deg.push_back(*row.angle_deg);
}

const Columns<PrintedValue>& printed_columns()
{
    static const Columns<PrintedValue> columns =
        Columns<PrintedValue>{{"claim", &PrintedValue::claim, "", "id of the claim"},
                              {"quantity", &PrintedValue::quantity, "", "what is printed"}} +
        within(&PrintedValue::of, case_key_columns()) +
        Columns<PrintedValue>{{"printed", &PrintedValue::printed, "", "the printed value"},
                              {"least", &PrintedValue::least, "", "its lower bound"},
                              column_with_empty(std::numeric_limits<double>::infinity(), "most", &PrintedValue::most, "",
                                                "its upper bound; empty if there is none")};
    return columns;
}

}  // namespace

std::vector<CaseRecord> case_records(const CsvTable& metrics, const std::string& run)
{
    const std::vector<MetricsRow> rows = rows_of(metrics_columns(), metrics);
    std::vector<CaseRecord> records;
    std::map<decltype(case_of(rows.front())), std::size_t> places;
    for (const MetricsRow& row : rows) {
        const auto [place, is_new] = places.try_emplace(case_of(row), records.size());
        if (is_new) records.push_back(empty_record(row, run));
        CaseRecord& record = records[place->second];
        if (record.iterations == 0 && row.outcome == "not_converged")
            ++record.frames_not_converged;
        else
            add_frame(record, row);
    }
    for (const CaseRecord& record : records) require_whole(record);
    return records;
}

void require_whole(const CaseRecord& record)
{
    const std::size_t frames = record.frame.size();
    const bool angles_fit = record.angle_deg.empty() || record.angle_deg.size() == frames;
    if (record.time_s.size() != frames || record.volume_change_pct.size() != frames || record.volume_abs_change_pct.size() != frames ||
        record.inverted_tets.size() != frames || !angles_fit)
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
