// Reading and writing files does not depend on the locale of the program that uses the library. Reference: the bytes that are written and
// the points that are read with the classic locale.
#include "pbs/geometry/mesh_io.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <locale>

namespace {

using test_support::ScratchFolder;

// 1.234,5 as in German
struct Commas : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

class DecimalComma : public testing::Test {
protected:
    DecimalComma() : before_(std::locale()) {}
    ~DecimalComma() override { std::locale::global(before_); }
    static void use_commas() { std::locale::global(std::locale(std::locale::classic(), new Commas)); }

    static std::string bytes_of(const std::string& path)
    {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    const ScratchFolder folder_;
    pbs::TetMesh mesh_;

private:
    void SetUp() override
    {
        // More than 999 points and tets, so that a thousands separator would be visible.
        constexpr int layers = 1200;
        mesh_.rest.resize(layers + 3, 3);
        mesh_.tets.resize(layers, 4);
        for (int v = 0; v < layers + 3; ++v) mesh_.rest.row(v) << std::cos(2.0 * v), std::sin(2.0 * v), 0.3 * v;
        for (int t = 0; t < layers; ++t) mesh_.tets.row(t) << t, t + 1, t + 2, t + 3;
    }
    std::locale before_;
};

TEST_F(DecimalComma, WritesTheSameBytes)
{
    for (const std::string ending : {".msh", ".mesh", ".vtu"}) {
        std::locale::global(std::locale::classic());
        pbs::write_tet_mesh(folder_ / ("classic" + ending), mesh_);
        use_commas();
        pbs::write_tet_mesh(folder_ / ("commas" + ending), mesh_);
        EXPECT_EQ(bytes_of(folder_ / ("commas" + ending)), bytes_of(folder_ / ("classic" + ending))) << ending;
    }
    pbs::write_pvd(folder_ / "commas.pvd", {{1234.5, "a.vtu"}});
    EXPECT_NE(bytes_of(folder_ / "commas.pvd").find("timestep=\"1234.5\""), std::string::npos);
}

TEST_F(DecimalComma, ReadsTheSamePoints)
{
    for (const std::string ending : {".msh", ".mesh", ".vtu"}) {
        std::locale::global(std::locale::classic());
        pbs::write_tet_mesh(folder_ / ("mesh" + ending), mesh_);
        use_commas();
        EXPECT_EQ(pbs::read_tet_frame(folder_ / ("mesh" + ending)).rest, mesh_.rest) << ending;
    }
}

}  // namespace
