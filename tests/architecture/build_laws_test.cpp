// Reference: the CMake files and the list of packages, compared with the actual source tree.
#include "tests/architecture/build_laws.hpp"
#include "tests/architecture/expect_lawful.hpp"
#include "tests/architecture/package_laws.hpp"

using namespace architecture;

TEST(BuildLaws, EverySourceIsBuilt)
{
    expect_lawful(orphaned_sources);
}
TEST(BuildLaws, UnitTestsMirrorTheSource)
{
    expect_lawful(unit_mirror);
}
TEST(BuildLaws, PackageListIsWellFormed)
{
    expect_lawful(package_list_form);
}
TEST(BuildLaws, PackageListCoversTheCMakeFiles)
{
    expect_lawful(package_list_cover);
}

TEST(BuildLawsBite, OrphanedSource)
{
    const SourceTree planted = {{"analysis/CMakeLists.txt", "add_library(analysis used.cpp)  # unused.cpp\n"},
                                {"analysis/used.cpp", ""},
                                {"analysis/unused.cpp", ""}};
    expect_found(orphaned_sources, planted, "analysis/unused.cpp");
}

TEST(BuildLawsBite, NamedOnlyInAnotherFolder)
{
    const SourceTree planted = {{"analysis/CMakeLists.txt", "add_library(analysis x.cpp)\n"}, {"experiments/x.cpp", ""}};
    expect_found(orphaned_sources, planted, "experiments/x.cpp");
}

TEST(BuildLawsBite, UnregisteredTest)
{
    const SourceTree planted = {{"tests/method.cmake", "pbs_tests(unit geometry FOLDERS geometry LIBRARIES skinning)\n"},
                                {"tests/unit/geometry/a.cpp", ""},
                                {"tests/unit/skinning/b.cpp", ""}};
    expect_found(orphaned_sources, planted, "tests/unit/skinning/b.cpp");
}

TEST(BuildLawsBite, TestOfTheSameNameInAnotherKind)
{
    const SourceTree planted = {{"tests/method.cmake", "pbs_tests(unit geometry FOLDERS geometry)\n"},
                                {"tests/unit/geometry/a.cpp", ""},
                                {"tests/properties/geometry/a.cpp", ""}};
    expect_found(orphaned_sources, planted, "tests/properties/geometry/a.cpp");
}

TEST(BuildLawsBite, TestThatItsFolderLeavesOut)
{
    const SourceTree planted = {{"tests/method.cmake",
                                 "pbs_tests(unit geometry FOLDERS geometry\n    EXCEPT geometry/a geometry/b)\n"
                                 "pbs_tests(unit meshes FILES geometry/a)\n"},
                                {"tests/unit/geometry/a.cpp", ""},
                                {"tests/unit/geometry/b.cpp", ""}};
    expect_found(orphaned_sources, planted, "tests/unit/geometry/b.cpp");
}

TEST(BuildLawsBite, UnitTestOfNothing)
{
    const SourceTree planted = {{"pbs/geometry/a.hpp", ""}, {"tests/unit/geometry/a.cpp", ""}, {"tests/unit/elsewhere/b.cpp", ""}};
    expect_found(unit_mirror, planted, "mirrors no source folder 'elsewhere'");
}

TEST(BuildLawsBite, UnknownGroup)
{
    expect_found(package_list_form, {{"cmake/packages.txt", "# list\ng++ 12 always compiler\n"}}, "cmake/packages.txt:2:");
}

TEST(BuildLawsBite, PackageWithoutPurpose)
{
    expect_found(package_list_form, {{"cmake/packages.txt", "g++ 12 run\n"}}, "packages.txt:1:");
}

TEST(BuildLawsBite, PackageTwice)
{
    expect_found(package_list_form, {{"cmake/packages.txt", "g++ 12 run a\ng++ 12 run b\n"}}, "g++ twice");
}

TEST(BuildLawsBite, LibraryOfNoPackage)
{
    const SourceTree planted = {{"cmake/packages.txt", "libgsl-dev 2 run [GSL] statistics\n"},
                                {"analysis/CMakeLists.txt", "find_package(GSL REQUIRED)\nfind_package(Boost)  # find_package(X)\n"}};
    expect_found(package_list_cover, planted, "analysis/CMakeLists.txt:2: Boost");
}
