// The state of a run in 32 hexadecimal digits: XXH3 128 of the bytes of all positions of all frames, in order. Two runs agree to the bit if
// their hashes do. `xxhsum -H2` on the little-endian Float64 of the frames, one after the other, gives the same hash.
//   StateHash hash;  for (frame...) hash.add(deformer.positions());  run["state_hash"] = hash.hex();
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <memory>
#include <string>

namespace analysis {

// A stream: only the bytes and their order matter, not the portions in which they are added.
class StateHash {
public:
    StateHash();
    ~StateHash();
    StateHash(StateHash&&) noexcept;             // an object that was moved from may only be assigned to
    StateHash& operator=(StateHash&&) noexcept;  // likewise

    void add(const pbs::Positions& positions);             // row by row, 24 bytes per vertex
    void add_bytes(const void* bytes, std::size_t count);  // as in memory; does nothing for count 0
    std::string hex() const;                               // the hash of everything added so far

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace analysis
