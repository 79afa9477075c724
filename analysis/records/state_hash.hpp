// The state of a run in 32 hexadecimal digits: XXH3 128 of the bytes of all positions of all frames, in order. Two runs agree to the bit
// where their hashes do. The same figure comes from `xxhsum -H2` on the little-endian Float64 of the frames, one after the other.
//   StateHash hash;  for (frame...) hash.add(deformer.positions());  run["state_hash"] = hash.hex();
#pragma once

#include "pbs/geometry/types.hpp"

#include <memory>
#include <string>

namespace analysis {

// A stream: only the bytes and their order count, not in which portions they were added.
class StateHash {
public:
    StateHash();
    ~StateHash();
    StateHash(StateHash&&) noexcept;             // what is moved from may only be assigned to
    StateHash& operator=(StateHash&&) noexcept;  // likewise

    void add(const pbs::Positions& positions);             // row after row, 24 bytes a vertex
    void add_bytes(const void* bytes, std::size_t count);  // as they lie in memory; none for 0
    std::string hex() const;                               // of what was added so far

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace analysis
