#include "analysis/records/toml_keys.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/studies/study.hpp"
#include "generated/cases_texts.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace experiments {
namespace {

// The keys of a form, a body or an entry of `each` replace those that all have in common, except the overrides, which
// follow the common ones. Tables are merged.
void add_keys(nlohmann::json& values, const nlohmann::json& own)
{
    nlohmann::json overrides = values.value("overrides", nlohmann::json::array());
    for (const nlohmann::json& override : own.value("overrides", nlohmann::json::array()))
        overrides.push_back(override);
    values.merge_patch(own);
    if (values.contains("overrides")) values["overrides"] = overrides;
}

void select(nlohmann::json& values, const std::vector<std::string>& tables, const std::string& selected)
{
    const nlohmann::json chosen = values.value(selected, nlohmann::json::object());
    for (const std::string& table : tables) values.erase(table);
    add_keys(values, chosen);
}

// A case with a list `each` stands for one case per entry, which has the keys of both.
nlohmann::json each_of(const nlohmann::json& cases)
{
    nlohmann::json expanded = nlohmann::json::array();
    for (nlohmann::json common : cases) {
        const nlohmann::json entries = common.value("each", nlohmann::json::array({nlohmann::json::object()}));
        common.erase("each");
        for (const nlohmann::json& entry : entries) add_keys(expanded.emplace_back(common), entry);
    }
    return expanded;
}

// The case of one body and one form. A case without a table `quick` is measured in the default form as in the full one.
nlohmann::json resolved(nlohmann::json values, const std::string& body, bool full)
{
    std::vector<std::string> bodies;
    if (values.contains("bodies")) {
        bodies = values.at("bodies").get<std::vector<std::string>>();
        values.erase("bodies");
        values["body"] = body;
    }
    select(values, bodies, body);
    select(values, {"quick", "full"}, !full && values.contains("quick") ? "quick" : "full");
    std::string text = values.dump();
    for (std::size_t at = 0; (at = text.find("{body}", at)) != std::string::npos;) text.replace(at, 6, body);
    return nlohmann::json::parse(text);
}

void add_differences(const nlohmann::json& a, const nlohmann::json& b, const std::string& path,
                     std::vector<std::string>& differing)
{
    if (a == b) return;
    if (!a.is_object() || !b.is_object()) {
        differing.push_back(path);
        return;
    }
    nlohmann::json both = a;
    both.update(b);
    for (const auto& [name, value] : both.items())
        add_differences(a.value(name, nlohmann::json()), b.value(name, nlohmann::json()),
                        path.empty() ? name : path + "." + name, differing);
}

}  // namespace

nlohmann::json cases_document(const std::string& study)
{
    const auto cases = ::cases::by_name.find(study);
    if (cases == ::cases::by_name.end()) throw std::logic_error(fmt::format("the study {} has no cases.toml", study));
    std::ostringstream json;
    json << toml::json_formatter{analysis::parse_toml(*cases->second, study + "/cases.toml")};
    nlohmann::json tables = nlohmann::json::parse(json.str());
    tables["case"] = each_of(tables.at("case"));
    return tables;
}

std::vector<std::string> differing_paths(const nlohmann::json& a, const nlohmann::json& b)
{
    std::vector<std::string> differing;
    add_differences(a, b, "", differing);
    return differing;
}

StudyCase::StudyCase(const std::string& study, const nlohmann::json& values, bool is_full)
    : name(values.at("name").get<std::string>()),
      cost_s(values.at(is_full ? "full_s" : "quick_s").get<double>()),
      where_(study + "/cases.toml: case " + name),
      values_(values),
      read_({"name", "body", "quick_s", "full_s"})
{
}

const nlohmann::json& StudyCase::at(const std::string& key) const
{
    read_.insert(key);
    if (!values_.contains(key)) throw std::logic_error(fmt::format("{}: no key {}", where_, key));
    return values_.at(key);
}

bool StudyCase::has(const std::string& key) const
{
    read_.insert(key);
    return values_.contains(key);
}

Scene StudyCase::scene(const Overrides& further) const
{
    auto overrides = value<Overrides>("overrides", {});
    overrides.insert(overrides.end(), further.begin(), further.end());
    return read_scene(value<std::string>("scene"), overrides);
}

DeformerSpec StudyCase::further_pbs(const nlohmann::json& table, const Overrides& further) const
{
    Overrides overrides = {R"(deformers.use=["pbs"])", R"(reference.name="")"};
    for (const Overrides& own : {table.value("overrides", Overrides()), further})
        overrides.insert(overrides.end(), own.begin(), own.end());
    DeformerSpec spec = scene(overrides).deformers.front();
    spec.label = table.at("label");
    spec.name = table.value("name", spec.name);
    spec.variant = table.value("variant", spec.variant);
    return spec;
}

StudyRun StudyCase::scene_run(const std::string& run_name, const Overrides& further) const
{
    StudyRun run{.name = run_name, .scene = scene(further), .cost_s = cost_s};
    run.scene.name = run_name;
    run.motion = value<std::string>("motion", "");
    return run;
}

pbs::Vec3 StudyCase::direction(const std::string& key) const
{
    const auto along = value<std::vector<double>>(key, {0.0, 1.0, 0.0});
    return {along.at(0), along.at(1), along.at(2)};
}

const nlohmann::json& StudyCase::values() const
{
    for (const auto& [key, value] : values_.items()) read_.insert(key);
    return values_;
}

analysis::CaseKey StudyCase::key() const
{
    analysis::CaseKey key{.body = value<std::string>("body", ""), .motion = value<std::string>("motion")};
    key.pose = value<std::string>("pose", "");
    if (has("angle_deg")) key.angle_deg = value<double>("angle_deg");
    return key;
}

void StudyCase::require_nothing_unread() const
{
    for (const auto& [key, value] : values_.items())
        if (!read_.contains(key)) throw std::logic_error(fmt::format("{}: nothing reads the key {}", where_, key));
}

StudyPlan plan_of_cases(const std::string& study, bool full,
                        const std::function<void(const StudyCase& study_case, StudyPlan& plan)>& add)
{
    StudyPlan plan;
    const nlohmann::json cases = cases_document(study).at("case");
    const auto is_left_out = [&](const std::string& body) {
        return std::ranges::count(plan.left_out, body, &analysis::LeftOut::scene) > 0;
    };
    const auto add_case = [&](const nlohmann::json& values, const std::string& body) {
        const nlohmann::json own = resolved(values, body, full);
        if (!own.contains(full ? "full_s" : "quick_s") || is_left_out(body)) return;
        try {
            if (values.contains("bodies")) pbs::require_body(body);
            const StudyCase study_case(study, own, full);
            add(study_case, plan);
            study_case.require_nothing_unread();
        } catch (const pbs::InputError& error) {
            if (body.empty()) throw;
            plan.left_out.push_back({body, error.what()});
        }
    };
    for (std::size_t first = 0, last = 0; first < cases.size(); first = last) {
        const nlohmann::json bodies =
            cases[first].value("bodies", nlohmann::json::array({cases[first].value("body", "")}));
        // A list of bodies goes through the cases that have it, body by body.
        for (last = first + 1; cases[first].contains("bodies") && last < cases.size() &&
                               cases[last].value("bodies", nlohmann::json()) == bodies;)
            ++last;
        for (const std::string body : bodies)
            for (std::size_t entry = first; entry < last; ++entry) add_case(cases[entry], body);
    }
    return plan;
}

}  // namespace experiments
