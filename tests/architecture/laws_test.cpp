// The laws of the architecture hold for the actual source tree, and each law finds what is planted: a law that accepts a planted violation
// proves nothing. References: the project's rules on includes, sizes, build files and text.
#include "tests/architecture/laws.hpp"

using namespace architecture;

namespace {

struct NamedLaw {
    std::string name;
    Law law;
};

void PrintTo(const NamedLaw& law, std::ostream* out)
{
    *out << law.name;
}

class Laws : public testing::TestWithParam<NamedLaw> {};

TEST_P(Laws, HoldForTheSourceTree)
{
    const SourceTree tree = read_source_tree();
    ASSERT_TRUE(tree.contains("CMakeLists.txt")) << "the source tree was not found";
    std::string found;
    for (const std::string& violation : GetParam().law(tree)) found += "\n" + violation;
    EXPECT_TRUE(found.empty()) << found;
}

const NamedLaw all_laws[] = {
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
    {"PackageListIsWellFormed", package_list_form},
    {"PackageListCoversTheCMakeFiles", package_list_cover},
    {"FoldersKeepTheirBudgets", [](const SourceTree& tree) { return folder_sizes(tree, budgets()); }},
    {"NoFileIsTooSmall", [](const SourceTree& tree) { return small_files(tree, budgets()); }},
    {"NoFileIsTooLong", file_sizes},
    {"Functions", function_sizes},
    {"Lines", line_lengths},
    {"NoPathOfOneMachine", absolute_paths},
    {"NoUnfinishedMarks", unfinished_marks},
    {"NoStrayWhitespace", stray_whitespace},
};

INSTANTIATE_TEST_SUITE_P(, Laws, testing::ValuesIn(all_laws), [](const auto& info) { return info.param.name; });

std::string including(const std::string& header)
{
    return "#include \"" + header + "\"\n";
}

SourceTree nine_files(const std::string& folder, const std::string& text)
{
    SourceTree nine;
    for (int i = 0; i < 9; ++i) nine[folder + "x" + std::to_string(i) + ".cpp"] = text;
    return nine;
}

const std::string kernel_library = "add_library(pbs_kernels OBJECT solver/k.cpp)\n";

std::string lines(int count)
{
    std::string text;
    for (int i = 0; i < count; ++i) text += "    line();\n";
    return text;
}

const std::vector<Budget> made_up = {{.what = "libraries",
                                      .folders = {"pbs/", "analysis/"},
                                      .endings = {".cpp", ".hpp"},
                                      .most_lines = 1000,
                                      .most_files = 8,
                                      .least_mean = 80,
                                      .small_files = 1}};

const Law made_up_folder_sizes = [](const SourceTree& tree) { return folder_sizes(tree, made_up); };
const Law made_up_small_files = [](const SourceTree& tree) { return small_files(tree, made_up); };
const std::string used = including("pbs/small.hpp");

// The law finds exactly one violation in the planted files, and its text contains `expected`; nothing is found where that is "". One letter
// of each forbidden text is written by its code, so that this file itself obeys the law.
struct Planted {
    std::string name;
    Law law;
    SourceTree files;
    std::string expected;
};

const Planted planted[] = {
    {"SourcesInAFolderWithoutALaw", include_direction, {{"extras/x.cpp", ""}}, "no include law knows"},
    {"LawsIncludeTheirOptions", include_direction, {{"reference_fem/laws/x.cpp", including("reference_fem/options.hpp")}}, ""},
    {"AFolderOfExperimentsWithoutALayer", layer_direction, {{"experiments/extras/x.cpp", ""}}, "no layer knows"},
    {"ExperimentsThemselvesWithoutALayer", layer_direction, {{"experiments/x.cpp", ""}}, "no layer knows"},
    {"RelativeInclude", include_form, {{"analysis/x.cpp", including("y.hpp")}}, "no such file"},
    {"AngleBrackets", include_form, {{"analysis/x.cpp", "#include <analysis/y.hpp>\n"}}, "ours goes in quotes"},
    {"HeaderWithoutPragmaOnce", include_form, {{"analysis/x.hpp", "int f();\n"}}, "#pragma once"},
    {"AFigureRunsTheSolver", values_compute, {{"paper_figures/x.py", "import csv\nimport subprocess\n"}}, "x.py:2: a figure reads records"},
    {"AStudyTestsForAKind", deformers_tested_by_name, {{"experiments/studies/x/y.cpp", "if (spec.kind == \"pbs\") f();\n"}}, "y.cpp:1: "},
    {"AStudyTestsForNoKind", deformers_tested_by_name, {{"experiments/studies/x/y.cpp", "return a.kind != \"fem\";\n"}}, "y.cpp:1: "},
    {"AStudyTestsForTheBeginningOfAKind",
     deformers_tested_by_name,
     {{"experiments/studies/x/y.cpp", "return spec.kind.starts_with(\"xpbd\");\n"}},
     "depends on the name of a deformer's kind: ask its traits or options"},
    {"ADeformerTestsForAKind", deformers_tested_by_name, {{"experiments/deformers/x/y.cpp", "if (spec.kind == \"pbs\") f();\n"}}, ""},
    {"AStudySetsAKind", deformers_tested_by_name, {{"experiments/studies/x/y.cpp", "of.kind = \"pbs\";\n"}}, ""},
    {"HeavyHeaderThroughAHeader",
     heavy_headers,
     {{"pbs/geometry/meshing_cgal.hpp", "#include <CGAL/Kernel.h>\n"}, {"pbs/solver/x.cpp", including("pbs/geometry/meshing_cgal.hpp")}},
     "pbs/solver/x.cpp:1: sees CGAL/"},
    {"TooManyHeavyFiles", heavy_headers, nine_files("reference_fem/", "#include <deal.II/base/point.h>\n"),
     "deal.II/ is seen by 9 .cpp files"},

    {"EigenInAKernelThroughAHeader",
     kernel_includes,
     {{"pbs/CMakeLists.txt", kernel_library},
      {"pbs/solver/k.cpp", including("pbs/solver/k.hpp")},
      {"pbs/solver/k.hpp", "#include <cstdint>\n#include <Eigen/Core>\n"}},
     "pbs/solver/k.cpp:1: a kernel sees <Eigen/Core>"},
    {"AContainerInAKernel",
     kernel_includes,
     {{"pbs/CMakeLists.txt", kernel_library}, {"pbs/solver/k.cpp", "#include <array>\n#include <vector>\n"}},
     "a kernel sees <vector>"},
    {"NoKernelsFound", kernel_includes, {{"pbs/CMakeLists.txt", "add_library(other k.cpp)\n"}}, "no sources"},
    {"FlagsForEverybody",
     machine_flags,
     {{"pbs/CMakeLists.txt", "target_compile_options(pbs_kernels PRIVATE -march=native)\nadd_compile_options(-march=native)  # -march\n"}},
     "pbs/CMakeLists.txt:2:"},
    {"RegistersElsewhere",
     registers_at_home,
     {{"pbs/CMakeLists.txt", kernel_library},
      {"pbs/solver/k.cpp", including("pbs/solver/lanes.hpp")},
      {"pbs/solver/x.cpp", including("pbs/solver/lanes.hpp")},
      {"pbs/solver/lanes.hpp", "#include <experimental/simd>\n"}},
     "pbs/solver/x.cpp:1: no kernel, and sees <experimental/simd>"},
    {"OrphanedSource",
     orphaned_sources,
     {{"analysis/CMakeLists.txt", "add_library(analysis used.cpp)  # unused.cpp\n"},
      {"analysis/used.cpp", ""},
      {"analysis/unused.cpp", ""}},
     "analysis/unused.cpp"},
    {"NamedOnlyInAnotherFolder",
     orphaned_sources,
     {{"analysis/CMakeLists.txt", "add_library(analysis x.cpp)\n"}, {"experiments/x.cpp", ""}},
     "experiments/x.cpp"},
    {"UnregisteredTest",
     orphaned_sources,
     {{"tests/method.cmake", "pbs_tests(unit geometry FOLDERS geometry LIBRARIES skinning)\n"},
      {"tests/unit/geometry/a.cpp", ""},
      {"tests/unit/skinning/b.cpp", ""}},
     "tests/unit/skinning/b.cpp"},
    {"TestOfTheSameNameInAnotherKind",
     orphaned_sources,
     {{"tests/method.cmake", "pbs_tests(unit geometry FOLDERS geometry)\n"},
      {"tests/unit/geometry/a.cpp", ""},
      {"tests/properties/geometry/a.cpp", ""}},
     "tests/properties/geometry/a.cpp"},
    {"TestThatItsFolderLeavesOut",
     orphaned_sources,
     {{"tests/method.cmake",
       "pbs_tests(unit geometry FOLDERS geometry\n    EXCEPT geometry/a geometry/b)\npbs_tests(unit meshes FILES geometry/a)\n"},
      {"tests/unit/geometry/a.cpp", ""},
      {"tests/unit/geometry/b.cpp", ""}},
     "tests/unit/geometry/b.cpp"},
    {"UnitTestOfNothing",
     unit_mirror,
     {{"pbs/geometry/a.hpp", ""}, {"tests/unit/geometry/a.cpp", ""}, {"tests/unit/elsewhere/b.cpp", ""}},
     "mirrors no source folder 'elsewhere'"},
    {"UnknownGroup", package_list_form, {{"cmake/packages.txt", "# list\ng++ 12 always compiler\n"}}, "cmake/packages.txt:2:"},
    {"PackageWithoutPurpose", package_list_form, {{"cmake/packages.txt", "g++ 12 run\n"}}, "packages.txt:1:"},
    {"PackageTwice", package_list_form, {{"cmake/packages.txt", "g++ 12 run a\ng++ 12 run b\n"}}, "g++ twice"},
    {"LibraryOfNoPackage",
     package_list_cover,
     {{"cmake/packages.txt", "libgsl-dev 2 run [GSL] statistics\n"},
      {"analysis/CMakeLists.txt", "find_package(GSL REQUIRED)\nfind_package(Boost)  # find_package(X)\n"}},
     "analysis/CMakeLists.txt:2: Boost"},

    {"FileOver500Lines",
     file_sizes,
     {{"analysis/x.cpp", lines(501)}, {"analysis/y.cpp", lines(500)}},
     "analysis/x.cpp:1: file of 501 lines"},
    {"FunctionOver60Lines",
     function_sizes,
     {{"analysis/x.cpp", "int f()\n{\n" + lines(60) + "}\n"}},
     "analysis/x.cpp:1: function of 62 lines"},
    {"MethodInAClass",
     function_sizes,
     {{"analysis/x.hpp", "class A {\n    int f()\n    {\n" + lines(60) + "    }\n};\n"}},
     "function of 62 lines"},
    {"ShortFunction", function_sizes, {{"analysis/x.cpp", "int f()\n{\n" + lines(10) + "}\n"}}, ""},
    {"BudgetOfLines",
     made_up_folder_sizes,
     {{"pbs/x.cpp", lines(400)}, {"analysis/a/x.cpp", lines(400)}, {"analysis/b/x.hpp", lines(203)}, {"tests/x.cpp", lines(400)}},
     "libraries: 1003 lines, at most 1000: 3 too many"},
    {"BudgetKept", made_up_folder_sizes, {{"pbs/x.cpp", lines(500)}, {"analysis/x.cpp", lines(500)}, {"analysis/x.py", lines(400)}}, ""},
    {"MeanOfARoom",
     made_up_folder_sizes,
     {{"pbs/solver/x.cpp", lines(79)}, {"pbs/solver/y.cpp", lines(80)}, {"pbs/y.cpp", lines(200)}},
     "pbs/solver/: 79 lines per file in the mean, at least 80"},
    {"TooManyFiles", made_up_folder_sizes, nine_files("pbs/", lines(100)), "libraries: 9 files, at most 8: 1 too many"},
    {"SmallFilesWithinTheirNumber", made_up_small_files, {{"pbs/small.hpp", lines(59)}, {"pbs/x.cpp", lines(60)}}, ""},
    {"HeaderWithSeveralUsers",
     made_up_small_files,
     {{"pbs/small.hpp", ""}, {"pbs/one.cpp", ""}, {"tests/a.cpp", used}, {"tests/b.cpp", used}, {"tests/c.cpp", used}},
     ""},

    {"HomeFolder", absolute_paths, {{"analysis/x.cpp", "\n// see /\150ome/somebody/data\n"}}, "analysis/x.cpp:2"},
    {"UnfinishedMark", unfinished_marks, {{"analysis/x.cpp", "// \124ODO later\n"}}, "analysis/x.cpp:1: finish it"},
    {"Tab", stray_whitespace, {{"a.md", "tab\there\nclean\n"}}, "a.md:1"},
    {"BlankAtTheEnd", stray_whitespace, {{"a.md", "clean\nblank \n"}}, "a.md:2"},
};

TEST(LawsBite, FindWhatIsPlanted)
{
    for (const auto& [name, law, files, expected] : planted) {
        const Violations violations = law(files);
        EXPECT_EQ(violations.size(), expected.empty() ? 0u : 1u) << name;
        for (const std::string& violation : violations) EXPECT_NE(violation.find(expected), std::string::npos) << name << ": " << violation;
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
    {include_direction, "pbs/character/x.cpp", "tests/support/a.hpp", "pbs/character/"},
    {include_direction, "reference_fem/x.cpp", "pbs/solver/b.hpp", "reference_fem/"},
    {include_direction, "reference_fem/x.cpp", "reference_fem/verification/a.hpp", "reference_fem/"},
    {include_direction, "reference_fem/laws/x.cpp", "reference_fem/assembly.hpp", "reference_fem/laws/"},
    {include_direction, "reference_fem/verification/x.cpp", "analysis/metrics/error_norms.hpp", "reference_fem/verification/"},
    {include_direction, "analysis/records/x.cpp", "analysis/verdicts/verdict.hpp", "analysis/records/"},
    {include_direction, "analysis/statistics/x.cpp", "analysis/metrics/error_norms.hpp", "analysis/statistics/"},
    {layer_direction, "experiments/studies/stiffness/x.cpp", "experiments/studies/fit/a.hpp", "experiments/studies/stiffness/"},
    {layer_direction, "experiments/studies/ambiguity/x.cpp", "experiments/studies/jiggle/a.hpp", "experiments/studies/ambiguity/"},
    {layer_direction, "experiments/studies/shared/x.cpp", "experiments/studies/volume/a.hpp", "experiments/studies/shared/"},
    {layer_direction, "experiments/verdicts/x.cpp", "experiments/distributed/a.hpp", "experiments/verdicts/"},
};

// Between headers that everything may include: that of its own folder and one of the mesh.
TEST(LawsBite, ForbiddenIncludesAreFoundInTheirLine)
{
    for (const auto& [law, file, header, folder] : forbidden) {
        const std::string text = including(folder_of(file) + "/own.hpp") + "\n" + including(header) + including("pbs/geometry/a.hpp");
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

TEST(LawsBite, AHeaderWithTwoUsersAndItsOwnSource)
{
    const Violations found =
        made_up_small_files({{"pbs/small.hpp", lines(5)}, {"pbs/small.cpp", used}, {"tests/a.cpp", used}, {"tests/b.cpp", used}});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0], "pbs/small.cpp:1: file of 1 lines, at least 60 unless it is a header with 3 users");
    EXPECT_EQ(found[1], "pbs/small.hpp:1: file of 5 lines, at least 60 unless it is a header with 3 users");
}

TEST(LawsBite, LineOver140Columns)
{
    for (const std::string path : {"analysis/x.cpp", "analysis/x.hpp", "tests/x.py", "cmake/x.cmake", "pbs/CMakeLists.txt", "cmake/x.sh",
                                   "check", "paper_figures/x.js", "tests/x.mjs", "paper_figures/x.css", "experiments/sweeps/Snakefile"})
        EXPECT_EQ(line_lengths({{path, "\n" + std::string(141, 'x') + "\n"}}), Violations{path + ":2: 141 columns, at most 140"});
    std::string umlauts;
    for (int i = 0; i < 140; ++i) umlauts += "\u00fc";
    EXPECT_TRUE(line_lengths({{"analysis/x.cpp", std::string(140, 'x') + "\n" + umlauts + "\n"}}).empty());
    EXPECT_TRUE(line_lengths({{"README.md", std::string(141, 'x')}, {"package-lock.json", std::string(141, 'x')}}).empty());
}

}  // namespace
