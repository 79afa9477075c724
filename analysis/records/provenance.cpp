#include "analysis/records/provenance.hpp"

#include "generated/build_facts.hpp"

#include <fmt/core.h>
#include <gsl/gsl_version.h>
#include <nlohmann/json.hpp>
#include <xxhash.h>

#include <fstream>
#include <new>
#include <thread>

namespace analysis {
namespace {

std::string cpu_model()
{
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);)
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return "unknown";
}

std::map<std::string, std::string> own_libraries()
{
    const unsigned xxhash = XXH_versionNumber();
    return {{"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
            {"GSL", gsl_version},
            {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
            {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                          NLOHMANN_JSON_VERSION_PATCH)},
            {"toml++", PBS_TOMLPLUSPLUS_VERSION},
            {"xxHash", fmt::format("{}.{}.{}", xxhash / 10000, xxhash / 100 % 100, xxhash % 100)}};
}

}  // namespace

Provenance collect_provenance(int threads)
{
    return {.version = build_facts::version,
            .git_revision = build_facts::git_revision,
            .git_dirty = build_facts::git_dirty,
            .compiler = build_facts::compiler,
            .flags = build_facts::flags,
            .build_type = build_facts::build_type,
            .cpu_model = cpu_model(),
            .logical_cpus = static_cast<int>(std::thread::hardware_concurrency()),
            .threads = threads,
            .libraries = own_libraries(),
            .blas = {},
            .input_hashes = {}};
}

void to_json(nlohmann::json& document, const Provenance& provenance)
{
    document = {{"version", provenance.version},
                {"git_revision", provenance.git_revision},
                {"git_dirty", provenance.git_dirty},
                {"compiler", provenance.compiler},
                {"flags", provenance.flags},
                {"build_type", provenance.build_type},
                {"cpu_model", provenance.cpu_model},
                {"logical_cpus", provenance.logical_cpus},
                {"threads", provenance.threads},
                {"libraries", provenance.libraries},
                {"input_hashes", provenance.input_hashes}};
    if (!provenance.blas.empty()) document["blas"] = provenance.blas;
}

void StateHash::Free::operator()(XXH3_state_s* state) const
{
    XXH3_freeState(state);
}

StateHash::StateHash() : state_(XXH3_createState())
{
    if (!state_) throw std::bad_alloc{};
    XXH3_128bits_reset(state_.get());
}

void StateHash::add(const pbs::Positions& positions)
{
    add_bytes(positions.data(), sizeof(double) * static_cast<std::size_t>(positions.size()));
}

void StateHash::add_bytes(const void* bytes, std::size_t count)
{
    if (count > 0) XXH3_128bits_update(state_.get(), bytes, count);
}

std::string StateHash::hex() const
{
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace analysis
