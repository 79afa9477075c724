// Reference: the include laws of the architecture, compared with the actual source tree.
#include "tests/architecture/expect_lawful.hpp"
#include "tests/architecture/heavy_headers.hpp"
#include "tests/architecture/include_laws.hpp"

using namespace architecture;

TEST(IncludeLaws, PointOneWay)
{
    expect_lawful(include_direction);
}
TEST(IncludeLaws, ExperimentsPointOneWay)
{
    expect_lawful(layer_direction);
}
TEST(IncludeLaws, AreWrittenFromTheRootInQuotes)
{
    expect_lawful(include_form);
}
TEST(IncludeLaws, FiguresComputeNothing)
{
    expect_lawful(values_compute);
}
TEST(IncludeLaws, DeformersAreNotTestedByName)
{
    expect_lawful(deformers_tested_by_name);
}
TEST(IncludeLaws, HeavyHeadersStayAtHome)
{
    expect_lawful(heavy_headers);
}

TEST(IncludeLawsBite, TheJudgeIncludesTheJudged)
{
    expect_found(include_direction, {{"reference_fem/x.cpp", "#include \"pbs/geometry/a.hpp\"\n#include \"pbs/solver/b.hpp\"\n"}},
                 "reference_fem/x.cpp:2: reference_fem/ may not include pbs/solver/b.hpp");
}

TEST(IncludeLawsBite, TheMetricsIncludeSkinning)
{
    expect_found(include_direction, {{"analysis/x.hpp", "#include \"pbs/skinning/a.hpp\"\n"}}, "analysis/ may not include");
}

TEST(IncludeLawsBite, TheSolverIncludesSkinning)
{
    expect_found(include_direction, {{"pbs/solver/x.hpp", "#include \"pbs/skinning/a.hpp\"\n"}}, "pbs/solver/ may not include");
}

TEST(IncludeLawsBite, TheMethodIncludesTests)
{
    expect_found(include_direction, {{"pbs/character/x.cpp", "#include \"tests/support/a.hpp\"\n"}}, "may not include tests/");
}

TEST(IncludeLawsBite, SourcesInAFolderNobodyKnows)
{
    expect_found(include_direction, {{"extras/x.cpp", ""}}, "no include law knows");
}

TEST(IncludeLawsBite, TheReferenceIncludesItsVerification)
{
    expect_found(include_direction, {{"reference_fem/x.cpp", "#include \"reference_fem/verification/a.hpp\"\n"}},
                 "reference_fem/ may not include reference_fem/verification/a.hpp");
}

TEST(IncludeLawsBite, TheReferencesVerificationIncludesMetrics)
{
    expect_found(include_direction, {{"reference_fem/verification/x.cpp", "#include \"analysis/error_norms.hpp\"\n"}},
                 "reference_fem/verification/ may not include analysis/error_norms.hpp");
}

TEST(IncludeLawsBite, RecordsIncludeVerdicts)
{
    expect_found(include_direction, {{"analysis/records/x.cpp", "#include \"analysis/verdict.hpp\"\n"}},
                 "analysis/records/ may not include analysis/verdict.hpp");
}

TEST(IncludeLawsBite, AStudyIncludesAnother)
{
    expect_found(layer_direction, {{"experiments/studies/stiffness/x.cpp", "\n#include \"experiments/studies/fit/a.hpp\"\n"}},
                 "experiments/studies/stiffness/x.cpp:2: experiments/studies/stiffness/ may not include experiments/studies/fit/a.hpp");
}

TEST(IncludeLawsBite, AmbiguityAloneIncludesStudies)
{
    const SourceTree planted = {{"experiments/studies/ambiguity/x.cpp",
                                 "#include \"experiments/studies/jiggle/a.hpp\"\n#include \"experiments/verdicts/b.hpp\"\n"}};
    expect_found(layer_direction, planted, "x.cpp:2: experiments/studies/ambiguity/ may not include experiments/verdicts/b.hpp");
}

TEST(IncludeLawsBite, WhatStudiesShareIncludesAStudy)
{
    expect_found(layer_direction, {{"experiments/studies/shared/x.cpp", "#include \"experiments/studies/volume/a.hpp\"\n"}},
                 "experiments/studies/shared/ may not include");
}

TEST(IncludeLawsBite, EachLayerIncludesTheNext)
{
    const std::vector<std::string> rooms = {"process",        "settings", "deformers",      "scene",    "run",
                                            "studies/shared", "studies",  "studies/volume", "verdicts", "command_line"};
    for (std::size_t i = 0; i + 1 < rooms.size(); ++i) {
        const std::string lower = "experiments/" + rooms[i] + "/", upper = "experiments/" + rooms[i + 1] + "/";
        expect_found(layer_direction, {{lower + "x.hpp", "#include \"" + upper + "a.hpp\"\n"}}, lower + " may not include " + upper);
        EXPECT_TRUE(layer_direction({{upper + "x.hpp", "#include \"" + lower + "a.hpp\"\n"}}).empty()) << upper;
    }
}

TEST(IncludeLawsBite, SweepsAndVerdictsStandBesideEachOther)
{
    expect_found(layer_direction, {{"experiments/verdicts/x.cpp", "#include \"experiments/distributed/a.hpp\"\n"}},
                 "experiments/verdicts/ may not include experiments/distributed/");
}

TEST(IncludeLawsBite, AFolderOfExperimentsWithoutALayer)
{
    expect_found(layer_direction, {{"experiments/extras/x.cpp", ""}}, "no layer knows");
    expect_found(layer_direction, {{"experiments/x.cpp", ""}}, "no layer knows");
}

TEST(IncludeLawsBite, RelativeInclude)
{
    expect_found(include_form, {{"analysis/x.cpp", "#include \"y.hpp\"\n"}}, "no such file");
}

TEST(IncludeLawsBite, AngleBrackets)
{
    expect_found(include_form, {{"analysis/x.cpp", "#include <analysis/y.hpp>\n"}}, "ours goes in quotes");
}

TEST(IncludeLawsBite, HeaderWithoutPragmaOnce)
{
    expect_found(include_form, {{"analysis/x.hpp", "int f();\n"}}, "#pragma once");
}

TEST(IncludeLawsBite, AFigureRunsTheSolver)
{
    expect_found(values_compute, {{"paper_figures/x.py", "import csv\nimport subprocess\n"}}, "paper_figures/x.py:2: subprocess");
}

TEST(IncludeLawsBite, AStudyTestsForADeformersName)
{
    const std::string found = ":1: depends on the name of a deformer's kind";
    for (const char* line :
         {"if (spec.kind == \"pbs\") f();\n", "return a.kind != \"fem\";\n", "return spec.kind.starts_with(\"xpbd\");\n"})
        expect_found(deformers_tested_by_name, {{"experiments/studies/x/y.cpp", line}}, "experiments/studies/x/y.cpp" + found);
    EXPECT_TRUE(deformers_tested_by_name({{"experiments/deformers/x/y.cpp", "if (spec.kind == \"pbs\") f();\n"}}).empty());
    EXPECT_TRUE(deformers_tested_by_name({{"experiments/studies/x/y.cpp", "of.kind = \"pbs\";\n"}}).empty());
}

TEST(IncludeLawsBite, HeavyHeaderThroughAHeader)
{
    const SourceTree planted = {{"pbs/geometry/meshing_cgal.hpp", "#include <CGAL/Kernel.h>\n"},
                                {"pbs/solver/x.cpp", "#include \"pbs/geometry/meshing_cgal.hpp\"\n"}};
    expect_found(heavy_headers, planted, "pbs/solver/x.cpp:1: sees CGAL/");
}

TEST(IncludeLawsBite, TooManyHeavyFiles)
{
    SourceTree planted;
    for (int i = 0; i < 9; ++i) planted["reference_fem/x" + std::to_string(i) + ".cpp"] = "#include <deal.II/base/point.h>\n";
    expect_found(heavy_headers, planted, "deal.II/ is seen by 9 .cpp files");
}
