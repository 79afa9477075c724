// Where a record comes from: what was built, from which revision, on what kind of machine. No host name, no folder: two machines of a
// kind write the same text.
//   Provenance provenance = collect_provenance(threads);  provenance.libraries["deal.II"] = "9.4.1";
//   provenance.input_hashes["limb.toml"] = pbs::content_hash(bytes);  run["provenance"] = provenance;
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <string>

namespace analysis {

// What two machines of a kind agree on, and what a run adds to it.
struct Provenance {
    std::string version;                              // of pbskin
    std::string git_revision;                         // 40 digits; "unknown" without git or outside a checkout
    bool git_dirty = false;                           // tracked files differed from the revision when this was built
    std::string compiler, flags, build_type;          // of this build, as CMake knows them
    std::string cpu_model;                            // as /proc/cpuinfo has it
    int logical_cpus = 0;                             // 0 where the system does not tell
    int threads = 0;                                  // the run's
    std::map<std::string, std::string> libraries;     // name -> version; those of this module, others are added
    std::map<std::string, std::string> blas;          // library, core_type and who selected it; empty: the run used none
    std::map<std::string, std::string> input_hashes;  // file name -> pbs::content_hash
};

// Of this build and machine; input_hashes are left to the caller. threads: that the run uses.
Provenance collect_provenance(int threads);
void to_json(nlohmann::json& document, const Provenance& provenance);  // an object, keys as the fields are called

}  // namespace analysis
