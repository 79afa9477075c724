// Reference: the facts that every record must contain, and those that none may contain (host, user, folders).

#include "analysis/records/provenance.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cmath>
#include <regex>

namespace {

TEST(Provenance, NamesBuildAndMachine)
{
    const auto provenance = analysis::collect_provenance(3);
    EXPECT_TRUE(std::regex_match(provenance.version, std::regex("[0-9]+\\.[0-9]+\\.[0-9]+")));
    EXPECT_TRUE(std::regex_match(provenance.git_revision, std::regex("unknown|[0-9a-f]{40}")))
        << provenance.git_revision;
    EXPECT_FALSE(provenance.compiler.empty());
    EXPECT_FALSE(provenance.cpu_model.empty());
    EXPECT_EQ(provenance.threads, 3);
    EXPECT_GE(provenance.logical_cpus, 1);
    for (const char* library : {"Eigen", "GSL", "fmt", "nlohmann_json", "toml++", "xxHash"})
        EXPECT_TRUE(std::regex_match(provenance.libraries.at(library), std::regex("[0-9]+(\\.[0-9]+)+"))) << library;
}

TEST(Provenance, JsonCarriesAddedEntriesAndNoPlace)
{
    auto provenance = analysis::collect_provenance(1);
    provenance.libraries["deal.II"] = "9.4.1";
    provenance.input_hashes["limb.toml"] = "00ff";
    const nlohmann::json document = provenance;
    EXPECT_EQ(document.at("libraries").at("deal.II"), "9.4.1");
    EXPECT_EQ(document.at("input_hashes").at("limb.toml"), "00ff");
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    const std::string text = document.dump();
    EXPECT_EQ(text.find("\"" + std::string(host) + "\""), std::string::npos);
    EXPECT_FALSE(std::regex_search(text, std::regex("/(home|work|root|tmp|usr|build)\\b"))) << text;
}

// Reference: the test vector of XXH3 128 for empty input with seed 0 (xxHash's own sanity test), and the command
// `xxhsum -H2` for a file.

using analysis::StateHash;

TEST(StateHash, OfNothingAndOfBytesIsTheKnownAnswer)
{
    StateHash hash;
    EXPECT_EQ(hash.hex(), "99aa06d3014798d86001c324468d497f");
    hash.add_bytes("abc", 3);
    EXPECT_EQ(hash.hex(), "06b05ab6733a618578af5f94892f3950");  // printf abc | xxhsum -H2
}

TEST(StateHash, DependsOnTheOrderOfFramesAndTheLastBitAndGoesOnAfterBeingRead)
{
    const pbs::Positions a = pbs::Positions::Constant(3, 3, 1.0), b = pbs::Positions::Constant(3, 3, 2.0);
    pbs::Positions c = b;
    c(2, 2) = std::nextafter(2.0, 3.0);
    const auto hash_of = [](const pbs::Positions& first, const pbs::Positions& second) {
        StateHash hash;
        hash.add(first);
        hash.add(second);
        return hash.hex();
    };
    EXPECT_EQ(hash_of(a, b), hash_of(a, b));
    EXPECT_NE(hash_of(a, b), hash_of(b, a));
    EXPECT_NE(hash_of(a, b), hash_of(a, c));
    const pbs::Positions frame = pbs::Positions::Constant(5, 3, 0.25);
    StateHash hash, read_between;
    hash.add(frame);
    hash.add(frame);
    read_between.add(frame);
    const std::string first = read_between.hex();
    read_between.add(frame);
    EXPECT_NE(first, hash.hex());
    EXPECT_EQ(read_between.hex(), hash.hex());
}

}  // namespace
