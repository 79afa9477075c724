#include "tests/architecture/include_laws.hpp"

#include <regex>

namespace architecture {
namespace {

struct Law {
    std::string folder;
    std::vector<std::string> may_include;
};

const std::vector<Law> laws = {
    {"pbs/geometry/", {"pbs/geometry/"}},
    {"pbs/skinning/", {"pbs/geometry/", "pbs/skinning/"}},
    {"pbs/constraints/", {"pbs/geometry/", "pbs/constraints/"}},
    {"pbs/solver/", {"pbs/geometry/", "pbs/constraints/", "pbs/solver/"}},
    {"pbs/character/", {"pbs/"}},
    {"reference_fem/", {"pbs/geometry/", "reference_fem/"}},
    {"analysis/", {"pbs/geometry/", "analysis/"}},
    {"experiments/", {"pbs/", "reference_fem/", "analysis/", "experiments/"}},
    {"tests/", {"pbs/", "reference_fem/", "analysis/", "experiments/", "tests/"}},
};
const std::vector<std::string> ours = {"pbs/", "reference_fem/", "analysis/", "experiments/", "tests/", "paper_figures/"};
const std::string generated = "generated/";  // written by the build

const Law* law_for(const std::string& path)
{
    for (const Law& law : laws)
        if (path.starts_with(law.folder)) return &law;
    return nullptr;
}

Violations form_of_file(const SourceTree& tree, const std::string& path, const std::string& text)
{
    Violations violations;
    for (const Include& include : includes_of(text)) {
        const bool is_ours = starts_with_any(include.target, ours);
        if (is_ours && !include.quoted) violations.push_back(at(path, include.line, "<" + include.target + ">: ours goes in quotes"));
        if (include.quoted && !include.target.starts_with(generated) && !tree.contains(include.target))
            violations.push_back(at(path, include.line, "\"" + include.target + "\": no such file, seen from the root"));
    }
    if (path.ends_with(".hpp") && text.find("#pragma once") == std::string::npos) violations.push_back(at(path, 1, "no #pragma once"));
    return violations;
}

}  // namespace

Violations include_direction(const SourceTree& tree)
{
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!is_cpp(path)) continue;
        const Law* law = law_for(path);
        if (!law) {
            violations.push_back(at(path, 1, "in a folder no include law knows"));
            continue;
        }
        for (const Include& include : includes_of(text))
            if (starts_with_any(include.target, ours) && !starts_with_any(include.target, law->may_include))
                violations.push_back(at(path, include.line, law->folder + " may not include " + include.target));
    }
    return violations;
}

Violations include_form(const SourceTree& tree)
{
    Violations violations;
    for (const auto& [path, text] : tree)
        if (is_cpp(path)) {
            const Violations found = form_of_file(tree, path, text);
            violations.insert(violations.end(), found.begin(), found.end());
        }
    return violations;
}

Violations figures_compute(const SourceTree& tree)
{
    static const std::regex starts_programs(R"(\b(subprocess|ctypes|cffi|os\.system|os\.popen|os\.exec\w*|os\.spawn\w*|scipy)\b)");
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!path.starts_with("paper_figures/")) continue;
        int number = 0;
        for (const std::string& line : lines_of(text)) {
            ++number;
            std::smatch match;
            if (path.ends_with(".py") && std::regex_search(line, match, starts_programs))
                violations.push_back(at(path, number, match.str() + ": a figure reads records, it runs and solves nothing"));
        }
        if (is_cpp(path)) violations.push_back(at(path, 1, "compiled code among the figures"));
    }
    return violations;
}

Violations deformers_tested_by_name(const SourceTree& tree)
{
    static const std::regex compares(
        R"re(\bkind(\(\))?\s*([!=]=\s*["']|(\.|->)(starts_with|ends_with|find|compare)\()|["']\s*[!=]=\s*[\w.>-]*\bkind\b)re");
    Violations violations;
    for (const auto& [path, text] : tree) {
        const bool is_source = is_cpp(path) || path.ends_with(".py");
        if (!is_source || !starts_with_any(path, {"experiments/", "analysis/", "paper_figures/"}) ||
            path.starts_with("experiments/deformers/"))
            continue;
        int number = 0;
        for (const std::string& line : lines_of(text)) {
            ++number;
            if (std::regex_search(line, compares))
                violations.push_back(at(path, number, "depends on the name of a deformer's kind: ask its traits or options"));
        }
    }
    return violations;
}

}  // namespace architecture
