#include "tests/architecture/laws.hpp"

#include <algorithm>
#include <optional>

namespace architecture {
namespace {

struct FolderLaw {
    std::string folder;
    std::vector<std::string> may_include;
    std::vector<std::string> but_not = {};
};

// The first entry whose folder contains a file is the law for that file.
const std::vector<FolderLaw> folder_laws = {
    {"pbs/geometry/", {"pbs/geometry/"}},
    {"pbs/system/", {"pbs/geometry/", "pbs/system/"}},
    {"pbs/packed/", {"pbs/geometry/", "pbs/system/", "pbs/packed/"}},
    {"pbs/skinning/", {"pbs/geometry/", "pbs/packed/", "pbs/skinning/"}},
    {"pbs/constraints/", {"pbs/geometry/", "pbs/constraints/"}},
    {"pbs/contact/", {"pbs/geometry/", "pbs/packed/", "pbs/contact/"}},
    {"pbs/solver/", {"pbs/geometry/", "pbs/packed/", "pbs/constraints/", "pbs/contact/", "pbs/solver/"}},
    {"pbs/near_rest/", {"pbs/geometry/", "pbs/constraints/", "pbs/solver/", "pbs/near_rest/"}},
    {"pbs/author/", {"pbs/geometry/", "pbs/skinning/", "pbs/constraints/", "pbs/solver/", "pbs/author/"}},
    {"pbs/flesh/", {"pbs/geometry/", "pbs/system/", "pbs/packed/", "pbs/skinning/", "pbs/contact/", "pbs/flesh/"}},
    {"reference_fem/verification/", {"pbs/geometry/", "reference_fem/", "analysis/records/"}},
    {"reference_fem/laws/", {"pbs/geometry/", "reference_fem/laws/", "reference_fem/options.hpp"}},
    {"reference_fem/", {"pbs/geometry/", "pbs/system/", "reference_fem/"}, {"reference_fem/verification/"}},
    {"analysis/records/", {"pbs/geometry/", "pbs/system/", "analysis/records/"}},
    {"analysis/statistics/", {"pbs/geometry/", "analysis/records/", "analysis/statistics/"}},
    {"analysis/metrics/", {"pbs/geometry/", "analysis/statistics/", "analysis/metrics/"}},
    {"analysis/verdicts/", {"pbs/geometry/", "analysis/records/", "analysis/statistics/", "analysis/verdicts/"}},
    {"analysis/check/",
     {"pbs/geometry/", "analysis/records/", "analysis/statistics/", "analysis/metrics/", "analysis/check/"}},
    {"experiments/", {"pbs/", "reference_fem/", "analysis/", "experiments/"}},
    {"tests/", {"pbs/", "reference_fem/", "analysis/", "experiments/", "tests/"}},
};
const std::vector<std::string> ours = {"pbs/",         "reference_fem/", "analysis/",
                                       "experiments/", "tests/",         "paper_figures/"};
const std::string generated = "generated/";  // files that the build writes

// The folders of experiments from the bottom up. A file includes its own folder and lower ones; folders of one line do
// not include each other.
const std::vector<std::string> layers = {
    "experiments/(process|meshes)/",
    "experiments/rigs/",
    "experiments/clips/",
    "experiments/characters/",
    "experiments/settings/",
    "experiments/deformers/",
    "experiments/scene/",
    "experiments/run/",
    "experiments/trial/",
    "experiments/studies/shared/",
    // the files in the folder itself: study.hpp, the cases and the poses of references
    "experiments/studies/(?=[^/]+$)",
    "experiments/studies/[^/]+/",  // the folder of each study
    "experiments/reproduce/",
    "experiments/(references|verdicts|sweeps)/",
    "experiments/command_line/",
};

struct Place {
    std::string folder;
    std::size_t layer;
};

// Nothing if no layer contains the file.
std::optional<Place> place_of(const std::string& path)
{
    static const std::vector<std::regex> patterns(layers.begin(), layers.end());
    std::smatch match;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (std::regex_search(path, match, patterns[i], std::regex_constants::match_continuous))
            return Place{match.str(), i};
    return std::nullopt;
}

const FolderLaw* law_for(const std::string& path)
{
    for (const FolderLaw& law : folder_laws)
        if (path.starts_with(law.folder)) return &law;
    return nullptr;
}

struct HeavyLibrary {
    std::string header;                // the beginning of its includes
    std::vector<std::string> at_home;  // the places whose files may see it
    std::size_t most_files;            // limit for the number of .cpp files outside tests that see it
};

const std::vector<HeavyLibrary> heavy = {
    {"deal.II/", {"reference_fem/"}, 1},
    {"CGAL/", {"experiments/meshes/"}, 4},
    {"vtk", {"experiments/meshes/"}, 3},
    {"gmsh.h", {}, 0},
    {"assimp/", {"experiments/meshes/", "experiments/rigs/", "experiments/clips/"}, 4},
};

}  // namespace

Violations include_direction(const SourceTree& tree)
{
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!is_cpp(path)) continue;
        const FolderLaw* law = law_for(path);
        if (!law) {
            violations.push_back(at(path, 1, "in a folder no include law knows"));
            continue;
        }
        for (const Include& include : includes_of(text))
            if (starts_with_any(include.target, ours) &&
                (!starts_with_any(include.target, law->may_include) || starts_with_any(include.target, law->but_not)))
                violations.push_back(at(path, include.line, law->folder + " may not include " + include.target));
    }
    return violations;
}

Violations layer_direction(const SourceTree& tree)
{
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!is_cpp(path) || !path.starts_with("experiments/")) continue;
        const std::optional<Place> own = place_of(path);
        if (!own) {
            violations.push_back(at(path, 1, "in a folder of experiments that no layer knows"));
            continue;
        }
        for (const Include& include : includes_of(text)) {
            const std::optional<Place> other = place_of(include.target);
            const bool is_lower = other && (other->folder == own->folder || other->layer < own->layer);
            if (include.target.starts_with("experiments/") && !is_lower)
                violations.push_back(at(path, include.line, own->folder + " may not include " + include.target));
        }
    }
    return violations;
}

Violations include_form(const SourceTree& tree)
{
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!is_cpp(path)) continue;
        for (const auto& [line, target, quoted] : includes_of(text)) {
            if (starts_with_any(target, ours) && !quoted)
                violations.push_back(at(path, line, "<" + target + ">: ours goes in quotes"));
            if (quoted && !target.starts_with(generated) && !tree.contains(target))
                violations.push_back(at(path, line, "\"" + target + "\": no such file, seen from the root"));
        }
        if (path.ends_with(".hpp") && text.find("#pragma once") == std::string::npos)
            violations.push_back(at(path, 1, "no #pragma once"));
    }
    return violations;
}

Violations values_compute(const SourceTree& tree)
{
    static const std::regex starts_programs(
        R"(\b(subprocess|ctypes|cffi|os\.system|os\.popen|os\.exec\w*|os\.spawn\w*|scipy)\b)");
    const auto of_figures = [](const std::string& path) { return path.starts_with("paper_figures/"); };
    Violations violations = in_lines(
        tree, [&](const std::string& path) { return of_figures(path) && path.ends_with(".py"); }, starts_programs,
        "a figure reads records, it runs and solves nothing");
    for (const auto& [path, text] : tree)
        if (of_figures(path) && is_cpp(path)) violations.push_back(at(path, 1, "compiled code among the figures"));
    return violations;
}

Violations deformers_tested_by_name(const SourceTree& tree)
{
    static const std::regex compares(
        R"re(\bkind(\(\))?\s*([!=]=\s*["']|(\.|->)(starts_with|ends_with|find|compare)\()|)re"
        R"re(["']\s*[!=]=\s*[\w.>-]*\bkind\b)re");
    const auto concerns = [](const std::string& path) {
        return (is_cpp(path) || path.ends_with(".py")) &&
               starts_with_any(path, {"experiments/", "analysis/", "paper_figures/"}) &&
               !starts_with_any(path, {"experiments/deformers/", "experiments/meshes/", "experiments/rigs/",
                                       "experiments/clips/", "experiments/characters/"});
    };
    return in_lines(tree, concerns, compares, "depends on the name of a deformer's kind: ask its traits or options",
                    {"kind"});
}

Violations heavy_headers(const SourceTree& tree)
{
    Violations violations;
    std::map<std::string, std::size_t> files;
    for (const auto& [path, text] : tree) {
        if (!is_cpp(path) || path.starts_with("tests/")) continue;
        const std::set<std::string> seen = foreign_headers(tree, path);
        for (const auto& [header, at_home, most_files] : heavy) {
            const auto belongs_to = [&header = header](const std::string& target) {
                return target.starts_with(header);
            };
            if (std::ranges::none_of(seen, belongs_to)) continue;
            files[header] += path.ends_with(".cpp");
            if (!starts_with_any(path, at_home))
                violations.push_back(at(path, 1, "sees " + header + " outside its place"));
        }
    }
    for (const auto& [header, at_home, most_files] : heavy)
        if (files[header] > most_files)
            violations.push_back(header + " is seen by " + std::to_string(files[header]) + " .cpp files; at most " +
                                 std::to_string(most_files) + " may");
    return violations;
}

}  // namespace architecture
