// The laws of the architecture hold for the actual source tree, and each law finds what is planted: a law that accepts
// a planted violation proves nothing. References: the project's rules on includes, functions, build files and text.
#include "tests/architecture/laws.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <ranges>

using namespace architecture;

namespace {

std::string including(const std::string& header)
{
    return "#include \"" + header + "\"\n";
}

std::string lines(int count)
{
    std::string text;
    for (int i = 0; i < count; ++i) text += "    line();\n";
    return text;
}

const std::map<std::string, Law> all_laws = {
    {"IncludesPointOneWay", include_direction},
    {"ExperimentsPointOneWay", layer_direction},
    {"IncludesAreWrittenFromTheRootInQuotes", include_form},
    {"FiguresComputeNothing", values_compute},
    {"DeformersAreNotTestedByName", deformers_tested_by_name},
    {"HeavyHeadersStayAtHome", heavy_headers},
    {"KernelsSeeRawPointersAlone", kernel_includes},
    {"KernelsAloneAreBuiltForTheMachine", machine_flags},
    {"KernelsAloneSeeRegisters", registers_at_home},
    {"EverySourceIsBuilt", orphaned_sources},
    {"UnitTestsMirrorTheSource", unit_mirror},
    {"EveryTableOfCasesIsRead", unread_tables},
    {"PackageListIsWellFormed", package_list_form},
    {"PackageListCoversTheCMakeFiles", package_list_cover},
    {"Functions", function_sizes},
    {"Lines", line_lengths},
    {"NoPathOfOneMachine", absolute_paths},
    {"NoUnfinishedMarks", unfinished_marks},
    {"NoStrayWhitespace", stray_whitespace},
};

class Laws : public testing::TestWithParam<std::string> {};

TEST_P(Laws, HoldForTheSourceTree)
{
    const SourceTree tree = read_source_tree();
    ASSERT_TRUE(tree.contains("CMakeLists.txt")) << "the source tree was not found";
    std::string found;
    for (const std::string& violation : all_laws.at(GetParam())(tree)) found += "\n" + violation;
    EXPECT_TRUE(found.empty()) << found;
}

std::vector<std::string> names_of_all_laws()
{
    const auto names = std::views::keys(all_laws);
    return {names.begin(), names.end()};
}
INSTANTIATE_TEST_SUITE_P(, Laws, testing::ValuesIn(names_of_all_laws()), [](const auto& info) { return info.param; });

// The text of a planted file: as it stands, or in parts, of which a number stands for so many lines of code.
std::string planted_text(const nlohmann::json& written)
{
    if (written.is_string()) return written;
    std::string text;
    for (const nlohmann::json& part : written) text += part.is_number() ? lines(part) : part.get<std::string>();
    return text;
}

// planted.json: the law finds one violation in the planted files, whose text contains `finds`, or nothing where that is
// empty. A file x# stands for nine. One letter of each forbidden text is written by its code, so that the file itself
// obeys the law.
TEST(LawsBite, FindWhatIsPlanted)
{
    for (const nlohmann::json& planted :
         nlohmann::json::parse(std::ifstream(PBS_SOURCE_ROOT "/tests/architecture/planted.json"))) {
        SourceTree tree;
        for (const auto& [path, written] : planted.at("files").items())
            for (int i = 0; i < (path.find('#') == std::string::npos ? 1 : 9); ++i)
                tree[std::regex_replace(path, std::regex("#"), std::to_string(i))] = planted_text(written);
        const std::string name = planted.at("name"), finds = planted.at("finds");
        const Violations violations = all_laws.at(planted.at("law"))(tree);
        EXPECT_EQ(violations.size(), finds.empty() ? 0u : 1u) << name;
        for (const std::string& violation : violations)
            EXPECT_NE(violation.find(finds), std::string::npos) << name << ": " << violation;
    }
}

// A file whose folder may not include a header, and that folder.
struct ForbiddenInclude {
    Law law;
    std::string file, header, folder;
};
const ForbiddenInclude forbidden[] = {
    {include_direction, "analysis/metrics/x.hpp", "pbs/skinning/a.hpp", "analysis/metrics/"},
    {include_direction, "pbs/solver/x.hpp", "pbs/skinning/a.hpp", "pbs/solver/"},
    {include_direction, "pbs/flesh/x.cpp", "tests/support/a.hpp", "pbs/flesh/"},
    {include_direction, "reference_fem/x.cpp", "pbs/solver/b.hpp", "reference_fem/"},
    {include_direction, "reference_fem/x.cpp", "reference_fem/verification/a.hpp", "reference_fem/"},
    {include_direction, "reference_fem/laws/x.cpp", "reference_fem/assembly.hpp", "reference_fem/laws/"},
    {include_direction, "reference_fem/verification/x.cpp", "analysis/metrics/error_norms.hpp",
     "reference_fem/verification/"},
    {include_direction, "analysis/records/x.cpp", "analysis/verdicts/verdict.hpp", "analysis/records/"},
    {include_direction, "analysis/statistics/x.cpp", "analysis/metrics/error_norms.hpp", "analysis/statistics/"},
    {layer_direction, "experiments/studies/stiffness/x.cpp", "experiments/studies/jiggle/a.hpp",
     "experiments/studies/stiffness/"},
    {layer_direction, "experiments/studies/ambiguity/x.cpp", "experiments/studies/jiggle/a.hpp",
     "experiments/studies/ambiguity/"},
    {layer_direction, "experiments/studies/shared/x.cpp", "experiments/studies/volume/a.hpp",
     "experiments/studies/shared/"},
    {layer_direction, "experiments/verdicts/x.cpp", "experiments/sweeps/a.hpp", "experiments/verdicts/"},
};

// Between headers that everything may include: that of its own folder and one of the mesh.
TEST(LawsBite, ForbiddenIncludesAreFoundInTheirLine)
{
    for (const auto& [law, file, header, folder] : forbidden) {
        const std::string text =
            including(folder_of(file) + "/own.hpp") + "\n" + including(header) + including("pbs/geometry/a.hpp");
        EXPECT_EQ(law({{file, text}}), Violations{file + ":3: " + folder + " may not include " + header});
    }
}

TEST(LawsBite, EachLayerIncludesTheNext)
{
    const std::vector<std::string> rooms = {"process",        "settings", "deformers",      "scene",    "run",
                                            "studies/shared", "studies",  "studies/volume", "verdicts", "command_line"};
    for (std::size_t i = 0; i + 1 < rooms.size(); ++i) {
        const std::string lower = "experiments/" + rooms[i] + "/", upper = "experiments/" + rooms[i + 1] + "/";
        const Violations found = layer_direction({{lower + "x.hpp", including(upper + "a.hpp")}});
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NE(found[0].find(lower + " may not include " + upper), std::string::npos) << found[0];
        EXPECT_TRUE(layer_direction({{upper + "x.hpp", including(lower + "a.hpp")}}).empty()) << upper;
    }
}

TEST(LawsBite, LineOver120Columns)
{
    for (const std::string path :
         {"analysis/x.cpp", "analysis/x.hpp", "tests/x.py", "cmake/x.cmake", "pbs/CMakeLists.txt", "cmake/x.sh",
          "check", "paper_figures/x.js", "tests/x.mjs", "paper_figures/x.css", "experiments/sweeps/Snakefile"})
        EXPECT_EQ(line_lengths({{path, "\n" + std::string(121, 'x') + "\n"}}),
                  Violations{path + ":2: 121 columns, at most 120"});
    std::string umlauts;
    for (int i = 0; i < 120; ++i) umlauts += "\u00fc";
    EXPECT_TRUE(line_lengths({{"analysis/x.cpp", std::string(120, 'x') + "\n" + umlauts + "\n"}}).empty());
    EXPECT_TRUE(
        line_lengths({{"README.md", std::string(121, 'x')}, {"package-lock.json", std::string(121, 'x')}}).empty());
}

}  // namespace
