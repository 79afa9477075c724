// The provenance of a record: the build, its revision and the kind of machine. It contains no host name and no folder,
// so that two machines of a kind write the same text.
//   Provenance provenance = collect_provenance(threads);  provenance.libraries["deal.II"] = "9.4.1";
//   provenance.input_hashes["limb.toml"] = pbs::content_hash(bytes);  run["provenance"] = provenance;
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>
#include <string>

struct XXH3_state_s;  // of xxHash

namespace analysis {

// The facts that two machines of a kind share, and those that a run adds.
struct Provenance {
    std::string version;                           // version of pbskin
    std::string git_revision;                      // 40 digits; "unknown" without git or outside a checkout
    bool git_dirty = false;                        // tracked files differed from the revision at the time of the build
    std::string compiler, flags, build_type;       // of this build, as in CMake
    std::string cpu_model;                         // as in /proc/cpuinfo
    int logical_cpus = 0;                          // 0 if the system does not report it
    int threads = 0;                               // threads of the run
    std::map<std::string, std::string> libraries;  // name -> version; this module's own, to which others are added
    // library, core_type and who selected it; empty: the run used no BLAS
    std::map<std::string, std::string> blas;
    std::map<std::string, std::string> input_hashes;  // file name -> pbs::content_hash
};

// The provenance of this build and machine; the caller adds input_hashes. threads: the number that the run uses.
Provenance collect_provenance(int threads);
// an object whose keys are the names of the members
void to_json(nlohmann::json& document, const Provenance& provenance);

// The state of a run in 32 hexadecimal digits: XXH3 128 of the bytes of all positions of all frames, in order. Two runs
// agree to the bit if their hashes do. `xxhsum -H2` on the little-endian Float64 of the frames, one after the other,
// gives the same hash.
//   StateHash hash;  for (frame...) hash.add(deformer.positions());  run["state_hash"] = hash.hex();
// A stream: only the bytes and their order matter, not the portions in which they are added.
class StateHash {
public:
    StateHash();

    void add(const pbs::Positions& positions);             // row by row, 24 bytes per vertex
    void add_bytes(const void* bytes, std::size_t count);  // as in memory; does nothing for count 0
    std::string hex() const;                               // the hash of everything added so far

private:
    struct Free {
        void operator()(XXH3_state_s* state) const;
    };
    std::unique_ptr<XXH3_state_s, Free> state_;  // an object that was moved from may only be assigned to
};

}  // namespace analysis
