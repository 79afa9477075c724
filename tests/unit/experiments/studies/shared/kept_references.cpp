// Reference: the shapes and numbers that were packed. A coordinate is kept as a multiple of kept_quantum_m from a
// predicted one, so that it comes back within half of it; the rounding of the sum is below a thousand-millionth of
// that.
#include "experiments/studies/shared/kept_references.hpp"

#include "experiments/characters/body_cache.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <tuple>

namespace kept_references_tests {
namespace {

using namespace experiments;
using nlohmann::json;
using test_support::refusal_of;

constexpr double half_a_quantum_m = kept_quantum_m / 2.0 * (1.0 + 1e-9);
const pbs::Character bar = test_support::bar_character({6, 2, 2});

// A pose in which the bar is bent by 70 degrees. Each member has a shape of its own, unrelated to the one before;
// nu_0.49 was not reached.
KeptReferences bent_bar()
{
    KeptReferences references{
        .pose = "bar_bend_70", .body = "bar", .mesh_hash = pbs::content_hash(bar.mesh), .revision = "abc", .bones = {}};
    references.bones = pbs::joint_sweep(bar.skeleton, 1, pbs::Vec3::UnitZ(), 70.0, 2, 0.01).steps.back();
    test_support::RandomPoints random(5);
    for (const EnsembleMember& member : family()) {
        KeptReference& of = references.members.emplace_back(KeptReference{.member = member, .outcome = "reached"});
        of.newton_steps = static_cast<int>(references.members.size());
        of.seconds = 1.5 * of.newton_steps;
        of.at_tips.assign(bar.mesh.rest.rows(), false);
        if (member.name == "nu_0.49") {
            of.outcome = "not_reached";
            continue;
        }
        of.linear_distance_pct = random.number(0.1, 2.0);
        of.energy_j = random.number(0.1, 2.0);
        if (member.name != "held_parts") of.lowest_det_f = random.number(0.1, 1.0);
        of.positions = bar.mesh.rest;
        for (auto point : of.positions.rowwise()) point += random.point(0.3).transpose();
        of.at_tips[of.newton_steps] = of.at_tips[20] = true;
    }
    return references;
}

std::string deflated(const std::vector<std::uint8_t>& bytes)
{
    uLongf size = compressBound(bytes.size());
    std::string text(size, '\0');
    EXPECT_EQ(compress(reinterpret_cast<Bytef*>(text.data()), &size, bytes.data(), bytes.size()), Z_OK);
    return text.substr(0, size);
}

// The packed references with a change to what they state, as a program with other fields would write them.
std::string packed_with(const std::function<void(json& all)>& change)
{
    const std::string text = packed(bent_bar(), bar);
    std::vector<std::uint8_t> bytes(1 << 20);
    uLongf size = bytes.size();
    EXPECT_EQ(uncompress(bytes.data(), &size, reinterpret_cast<const Bytef*>(text.data()), text.size()), Z_OK);
    bytes.resize(size);
    json all = json::from_cbor(bytes);
    change(all);
    return deflated(json::to_cbor(all));
}

std::string refusal_of_text(const std::string& text, const pbs::Character& character = bar)
{
    return refusal_of([&] { unpacked(text, "kept.ref", character); });
}

TEST(KeptReferences, ComeBackWithinHalfAQuantumWithAllTheirNumbers)
{
    const KeptReferences before = bent_bar(), after = unpacked(packed(before, bar), "kept.ref", bar);
    EXPECT_EQ(std::tie(after.pose, after.body, after.mesh_hash, after.revision),
              std::tie(before.pose, before.body, before.mesh_hash, before.revision));
    ASSERT_EQ(after.bones.size(), before.bones.size());
    for (std::size_t b = 0; b < after.bones.size(); ++b) EXPECT_EQ(after.bones[b].matrix(), before.bones[b].matrix());
    ASSERT_EQ(after.members.size(), 8u);
    for (std::size_t m = 0; m < after.members.size(); ++m) {
        const KeptReference &one = after.members[m], &was = before.members[m];
        SCOPED_TRACE(was.member.name);
        EXPECT_EQ(to_json(one.member), to_json(was.member));
        const auto numbers = [](const KeptReference& of) {
            return std::tie(of.outcome, of.linear_distance_pct, of.energy_j, of.lowest_det_f, of.newton_steps,
                            of.seconds, of.at_tips);
        };
        EXPECT_EQ(numbers(one), numbers(was));
        ASSERT_EQ(one.positions.rows(), was.positions.rows());
        if (!was.is_reached()) continue;
        const double largest_m = (one.positions - was.positions).cwiseAbs().maxCoeff();
        EXPECT_LE(largest_m, half_a_quantum_m);
        EXPECT_GT(largest_m, 0.4 * kept_quantum_m) << "of random shapes of 63 vertices";
    }
}

TEST(KeptReferences, AreFoundByTheirMember)
{
    const KeptReferences references = unpacked(packed(bent_bar(), bar), "kept.ref", bar);
    ASSERT_NE(references.find("nu_0.3"), nullptr);
    EXPECT_EQ(references.find("nu_0.3")->member.poisson, 0.3);
    EXPECT_FALSE(references.find("nu_0.49")->is_reached());
    EXPECT_EQ(references.find("nu_0.5"), nullptr);
}

TEST(KeptReferences, EstimateTheirOwnErrorByTheDistanceOfLinearElements)
{
    EXPECT_DOUBLE_EQ((KeptReference{.member = {}, .outcome = "reached", .linear_distance_pct = 0.5}.own_error_pct()),
                     0.3);
    EXPECT_TRUE(std::isnan(KeptReference{}.own_error_pct()));
}

// A bit of each seventh byte is flipped, and the text ends before each seventh byte. Zlib's checksum, Adler-32, misses
// few flips: those of padding, and some that change neighbouring bytes by the same amounts in opposite directions.
TEST(KeptReferences, ThatAreDamagedAreRefused)
{
    const std::string whole = packed(bent_bar(), bar);
    ASSERT_EQ(refusal_of_text(whole), "accepted");
    int refused = 0, missed = 0;
    for (std::size_t place = 0; place < whole.size(); place += 7) {
        std::string flipped = whole;
        flipped[place] ^= 16;
        for (const std::string& damaged : {flipped, whole.substr(0, place)}) {
            const std::string message = refusal_of_text(damaged);
            const bool is_missed = message == "accepted" && damaged.size() == whole.size();
            EXPECT_TRUE(is_missed || message.starts_with("kept.ref: is no file of references, or damaged: "))
                << place << ": " << message;
            ++(is_missed ? missed : refused);
        }
    }
    EXPECT_GT(refused, 1000);
    EXPECT_LE(missed, 5);
}

struct WrongText {
    std::string message;
    std::function<void(json& all)> change;
};

// Whole files that another program, or a person, has written.
TEST(KeptReferences, OfAnotherFormOrSizeAreRefused)
{
    const std::string damaged = "is no file of references, or damaged: ";
    const std::vector<WrongText> wrong = {{"schema = 2: expected 1", [](json& all) { all["schema"] = 2; }},
                                          {damaged,
                                           [](json& all) {
                                               all = json::array({1, 2});
                                           }},
                                          {damaged, [](json& all) { all.erase("quantum_m"); }},
                                          {damaged, [](json& all) { all["pose"] = 7; }},
                                          {"a member soft that this program does not have",
                                           [](json& all) { all["members"][1]["member"]["name"] = "soft"; }},
                                          {"a member nu_0.3 that this program does not have",
                                           [](json& all) { all["members"][4]["member"]["poisson"] = 0.31; }},
                                          {"a transform of another size", [](json& all) { all["bones"][1].erase(0); }},
                                          {"another number of bones", [](json& all) { all["bones"].erase(1); }},
                                          {damaged, [](json& all) { all["members"][0]["tips"] = {63}; }},
                                          {damaged, [](json& all) { all["members"][0]["tips"] = {-1}; }},
                                          {damaged, [](json& all) { all["members"][0].erase("shape"); }},
                                          {"a shape of another size", [](json& all) {
                                               json::binary_t bytes = all["members"][2]["shape"].get_binary();
                                               bytes.resize(bytes.size() - 4);
                                               all["members"][2]["shape"] = json::binary(bytes);
                                           }}};
    for (const auto& [message, change] : wrong) {
        const std::string refusal = refusal_of_text(packed_with(change));
        EXPECT_TRUE(refusal.starts_with("kept.ref: ") && refusal.find(message) != std::string::npos)
            << refusal << "\nexpected: " << message;
    }
    EXPECT_EQ(refusal_of_text(packed_with([](json&) {})), "accepted");
}

TEST(KeptReferences, OfOtherTetsAreRefusedByNameWithTheCommandThatSolvesThem)
{
    pbs::Character other = bar;
    other.mesh.rest(0, 0) += 1e-9;
    const std::string message = refusal_of_text(packed(bent_bar(), bar), other);
    for (const std::string& part :
         {std::string("kept.ref: mesh_hash = ") + pbs::content_hash(bar.mesh),
          "bar have the hash " + pbs::content_hash(other.mesh), std::string("`pbskin reproduce references --full`")})
        EXPECT_NE(message.find(part), std::string::npos) << message;
}

// A file has the pose of its name, with the bones where they are now.
TEST(KeptReferences, AreReadByTheNameAndTheBonesOfTheirPose)
{
    const test_support::ScratchFolder folder;
    const test_support::EnvironmentVariable in_use("PBSKIN_REFERENCES", folder.path());
    const KeptReferences references = bent_bar();
    const std::string file = folder.file("bar_bend_70.ref", packed(references, bar));
    folder.file("renamed.ref", packed(references, bar));
    EXPECT_EQ(file_of_references("bar_bend_70"), file);
    pbs::Pose nearly = references.bones, elsewhere = references.bones;
    nearly[1].translation().x() += 1e-12;
    elsewhere[1].translation().x() += 1e-6;
    for (const pbs::Pose& bones : {references.bones, nearly})
        EXPECT_EQ(read_references("bar_bend_70", bar, bones).members.size(), 8u);
    const auto expect_refused = [&](const std::string& pose, const pbs::Pose& bones, const std::string& begin,
                                    const std::string& rule) {
        const std::string message = refusal_of([&] { read_references(pose, bar, bones); });
        EXPECT_TRUE(message.starts_with(folder / begin) && message.find(rule) != std::string::npos) << message;
    };
    const std::string solve = "`pbskin reproduce references --full`";
    expect_refused("bar_bend_80", references.bones, "bar_bend_80.ref: does not exist: ", solve);
    expect_refused("renamed", references.bones,
                   "renamed.ref: pose = bar_bend_70: ", "expected the references of renamed");
    expect_refused("bar_bend_70", elsewhere, "bar_bend_70.ref: bones = forearm: ", solve);
}

// The tets of a body that are not kept come from the mesher of the system. Here the cache has some of them.
TEST(OtherTets, AreThoseThatTheReferencesOfTheBodyWereNotSolvedOn)
{
    const test_support::ScratchFolder folder;
    const std::string name = "bar-1800-v2-", kept = folder.path() / "tets";
    const test_support::EnvironmentVariable references("PBSKIN_REFERENCES", folder.path()),
        cache("PBSKIN_CACHE", folder.path());
    write_tet_mesh(folder / "bar.vtu", bar.mesh);
    std::filesystem::rename(folder / "bar.vtu", folder / (name + pbs::hash_of_file(folder / "bar.vtu") + ".vtu"));

    EXPECT_EQ(why_other_tets("bar"), "") << "there are no references";
    folder.file("bar_bend_70.ref", packed(bent_bar(), bar));
    EXPECT_EQ(why_other_tets("bar"), "") << "they were solved on these tets";
    folder.file("bar_bend_70.ref", packed_with([](json& all) { all["mesh_hash"] = "0123"; }));
    EXPECT_NE(why_other_tets("bar").find(" makes others than CGAL 5.5.1"), std::string::npos);
    const std::string refused = refusal_of([] { require_kept_tets("bar"); });
    for (const char* part : {"character.body = bar: ", "Debian 12", "`pbskin reproduce references --full`"})
        EXPECT_NE(refused.find(part), std::string::npos) << refused;
    std::filesystem::create_directory(kept);
    std::ofstream(kept + "/" + name + std::string(32, '0') + ".vtu") << "";
    const std::string damaged = refusal_of([] { why_other_tets("bar"); });
    EXPECT_NE(damaged.find("0.vtu: is damaged: the hash in its name is not that of its bytes"), std::string::npos)
        << damaged;
}

}  // namespace
}  // namespace kept_references_tests
