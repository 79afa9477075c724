#include "experiments/studies/study.hpp"

#include "analysis/records/record_files.hpp"
#include "generated/claims_texts.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>

namespace experiments {

namespace fs = std::filesystem;

std::vector<std::string> FinishedRuns::files(const std::string& file) const
{
    std::vector<std::string> paths;
    for (const std::string& run : folders)
        if (const fs::path path = fs::path(run) / file; fs::exists(path)) paths.push_back(path.string());
    return paths;
}

void FinishedRuns::write(const std::string& file, const std::string& text) const
{
    analysis::write_text_atomically((fs::path(folder) / file).string(), text);
}

void FinishedRuns::write(const std::string& file, const analysis::CsvTable& table) const
{
    table.write((fs::path(folder) / file).string());
}

const std::vector<analysis::Claim>& claims()
{
    static const std::vector<analysis::Claim> claims = analysis::parse_claims(::claims::claims_toml, "claims.toml");
    return claims;
}

bool is_asked_for(const analysis::Claim& claim, const std::string& name)
{
    return claim.id == name || page_of(claim) == name;
}

std::string page_of(const analysis::Claim& claim)
{
    return std::isalpha(static_cast<unsigned char>(claim.id.back())) ? claim.id.substr(0, claim.id.size() - 1)
                                                                     : claim.id;
}

const analysis::Claim& claim_named(const std::string& id)
{
    const auto found = std::ranges::find(claims(), id, &analysis::Claim::id);
    if (found == claims().end()) throw std::logic_error("no claim " + id);
    return *found;
}

}  // namespace experiments
