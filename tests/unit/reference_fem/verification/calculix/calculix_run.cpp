// Reference: what the stand-in programs do, shell scripts in the place of ccx.

#include "reference_fem/verification/calculix/calculix_run.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

#include <cstdlib>
#include <ostream>

namespace {

using namespace reference_fem;

class CalculixStandIn : public testing::Test {
protected:
    std::string program(const std::string& script)
    {
        const std::string path = folder_.file("ccx", "#!/bin/sh\n" + script);
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        return path;
    }
    static CalculixRun run(const std::string& program, double seconds = 20.0)
    {
        return run_calculix(program, [](std::ostream& deck) { deck << "the deck"; }, {seconds});
    }

    test_support::ScratchFolder folder_;
};

TEST_F(CalculixStandIn, GetsTheDeckAndItsFilesComeBack)
{
    const CalculixRun result = run(program("cp $2.inp $2.dat; echo $1 $2; echo raw > deck.rout\n"));
    EXPECT_EQ(result.outcome, CalculixOutcome::finished);
    EXPECT_EQ(result.printed, "the deck");
    EXPECT_EQ(result.restart, "raw\n");
    EXPECT_EQ(result.output, "-i deck\n");
    EXPECT_GT(result.wall_s, 0.0);
}

TEST_F(CalculixStandIn, RunsOnOneThreadInAFolderOfItsOwnThatIsRemoved)
{
    const CalculixRun result = run(program("echo $OMP_NUM_THREADS $OPENBLAS_NUM_THREADS; pwd\n"));
    std::istringstream output(result.output);
    std::string threads, path;
    std::getline(output, threads);
    std::getline(output, path);
    EXPECT_EQ(threads, "1 1");
    EXPECT_NE(path, std::filesystem::current_path().string());
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(CalculixStandIn, ErrorsAreRefusalsAndTheTimeLimitHolds)
{
    for (const char* script : {"exit 201\n", "echo ' *ERROR reading *NODE'\n", "kill -9 $$\n"})
        EXPECT_EQ(run(program(script)).outcome, CalculixOutcome::refused) << script;
    for (const std::string& path : {folder_ / "none", folder_.file("text", "no program")})
        EXPECT_EQ(run(path).outcome, CalculixOutcome::not_started) << path;
    const CalculixRun endless = run(program("exec sleep 30\n"), 0.1);
    EXPECT_EQ(endless.outcome, CalculixOutcome::out_of_time);
    EXPECT_LT(endless.wall_s, 10.0);
}

TEST_F(CalculixStandIn, ProcessorTimeIsThatOfTheProgram)
{
    EXPECT_LT(run(program("exec sleep 0.3\n")).cpu_s, 0.2);
    EXPECT_GT(run(program("i=0; while [ $i -lt 30000 ]; do i=$((i+1)); done\n")).cpu_s, 0.002);
}

TEST_F(CalculixStandIn, IsFoundOnThePath)
{
    const std::string before = std::getenv("PATH");
    setenv("PATH", folder_.path().c_str(), 1);
    EXPECT_EQ(calculix_on_path(), std::nullopt);
    const std::string path = program("echo 'This is Version 9.8_7'\n");
    EXPECT_EQ(calculix_on_path(), path);
    EXPECT_EQ(calculix_version(path), "CalculiX 9.8_7");
    std::filesystem::permissions(path, std::filesystem::perms::owner_read);
    EXPECT_EQ(calculix_on_path(), std::nullopt);
    setenv("PATH", "", 1);
    EXPECT_EQ(calculix_on_path(), std::nullopt);
    setenv("PATH", before.c_str(), 1);
}

TEST(LastWords, AreTheEndWithoutBlankLines)
{
    EXPECT_EQ(last_words("one\ntwo\n\n"), "one\ntwo");
    EXPECT_EQ(last_words(" \n"), "");
    std::string text = "end", last = text;
    text.insert(0, 1000, 'a');
    last.insert(0, 397, 'a');
    EXPECT_EQ(last_words(text), last);
}

// Reference: what was put into the files. Fortran prints 1p,e13.6, leaves the E of a three-digit exponent out, and puts a record's length
// before and after its data.

const std::string header = "\n displacements (vx,vy,vz) for set NODES and time  0.1000000E+01\n\n";
const std::string first = "         1  1.234568E-03 -2.000000E+00  0.000000E+00\n";
const std::string second = "         2 -7.654321E-12  3.333333E-01  1.234567-101\n";

template <typename Number>
std::string record(const std::vector<Number>& values)
{
    const auto length = static_cast<std::int32_t>(values.size() * sizeof(Number));
    const std::string around(reinterpret_cast<const char*>(&length), sizeof length);
    return around + std::string(reinterpret_cast<const char*>(values.data()), length) + around;
}

// Node by node: temperature and three displacements.
const std::vector<double> exact = {20.0, 1.2345678901e-3, -2.0, 0.0, 20.0, -7.6543210987e-12, 1.0 / 3.0, 1.234567e-101};

TEST(PrintedDisplacements, AreReadInAnyOrder)
{
    const pbs::Positions read = read_printed_displacements(header + second + first, "deck.dat", 2);
    EXPECT_EQ(read.row(0), Eigen::RowVector3d(1.234568e-3, -2.0, 0.0));
    EXPECT_EQ(read.row(1), Eigen::RowVector3d(-7.654321e-12, 3.333333e-1, 1.234567e-101));
}

TEST(PrintedDisplacements, MalformedFilesAreRefused)
{
    const std::string half = "\n displacements (vx,vy,vz) for set NODES and time  0.5000000E+00\n\n", once = header + first;
    const std::vector<std::pair<std::string, std::string>> all = {{"", "expected a block"},
                                                                  {first + second, "below a header"},
                                                                  {once, "node = 2"},
                                                                  {once + first + second, "one line per node"},
                                                                  {once + "         3  0.0 0.0 0.0\n", "expected 1 to 2"},
                                                                  {once + "       1.5  0.0 0.0 0.0\n", "expected 1 to 2"},
                                                                  {once + "         2  0.0 0.0\n", "three numbers"},
                                                                  {once + "         2  0.0 0.0 ******\n", "displacement = ******"},
                                                                  {once + "         2  0.0 NaN 0.0\n", "displacement = NaN"},
                                                                  {once + "         2  0.0 0.0 1.2x\n", "displacement = 1.2x"},
                                                                  {once + second + once + second, "one block"},
                                                                  {half + first + second, "time"}};
    for (const auto& [text, what] : all) {
        const std::string refusal = test_support::refusal_of([&] { read_printed_displacements(text, "deck.dat", 2); });
        EXPECT_TRUE(refusal.find("deck.dat") != std::string::npos && refusal.find(what) != std::string::npos) << text << "\n" << refusal;
    }
}

// Ends of springs are behind the nodes.
TEST(RestartFile, GivesTheDisplacementsInDouble)
{
    std::vector<double> others = exact, with_an_end = exact;
    others[1] += 1e-8;
    with_an_end.insert(with_an_end.end(), {20.0, 5.0, 6.0, 7.0});
    const std::string several = record<double>({1.0}) + record(others) + record<std::int32_t>({7, 8}) + record(exact) + record<char>({});
    for (const std::string& restart : {several, record(with_an_end)}) {
        const CalculixDisplacements read = read_displacements(header + first + second, restart, 2);
        EXPECT_TRUE(read.in_double);
        EXPECT_EQ(read.displacements, (pbs::Positions{{exact[1], exact[2], exact[3]}, {exact[5], exact[6], exact[7]}}));
    }
}

TEST(RestartFile, WithoutTheRecordThePrintedDigitsStay)
{
    std::vector<double> others = exact;
    others[6] = 0.3333344;  // the 7th digit differs
    for (const std::string& restart : {std::string(), record(others), record<double>({1.0, 2.0})}) {
        const CalculixDisplacements read = read_displacements(header + first + second, restart, 2);
        EXPECT_FALSE(read.in_double);
        EXPECT_EQ(read.displacements(0, 0), 1.234568e-3);
    }
}

TEST(RestartFile, CutShortOrDamagedIsRefused)
{
    const std::string restart = record(exact);
    for (std::size_t length = 1; length < restart.size(); ++length)
        EXPECT_THROW(read_displacements(header + first + second, restart.substr(0, length), 2), pbs::InputError) << length;
    std::string damaged = restart;
    damaged[damaged.size() - 1] ^= 1;
    EXPECT_THROW(read_displacements(header + first + second, damaged, 2), pbs::InputError);
}

}  // namespace
