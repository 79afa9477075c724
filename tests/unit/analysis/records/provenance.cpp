// Reference: the facts that every record must contain, and those that none may contain (host, user, folders).
#include "analysis/records/provenance.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <regex>

namespace {

TEST(Provenance, NamesBuildAndMachine)
{
    const auto provenance = analysis::collect_provenance(3);
    EXPECT_TRUE(std::regex_match(provenance.version, std::regex("[0-9]+\\.[0-9]+\\.[0-9]+")));
    EXPECT_TRUE(std::regex_match(provenance.git_revision, std::regex("unknown|[0-9a-f]{40}"))) << provenance.git_revision;
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

}  // namespace
