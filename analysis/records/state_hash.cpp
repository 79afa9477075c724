#include "analysis/records/state_hash.hpp"

#include <xxhash.h>

#include <new>

namespace analysis {

struct StateHash::State {
    State() : state(XXH3_createState())
    {
        if (!state) throw std::bad_alloc{};
        XXH3_128bits_reset(state);
    }
    ~State() { XXH3_freeState(state); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    XXH3_state_t* state;
};

StateHash::StateHash() : state_(std::make_unique<State>())
{
}
StateHash::~StateHash() = default;
StateHash::StateHash(StateHash&&) noexcept = default;
StateHash& StateHash::operator=(StateHash&&) noexcept = default;

void StateHash::add(const pbs::Positions& positions)
{
    add_bytes(positions.data(), sizeof(double) * static_cast<std::size_t>(positions.size()));
}

void StateHash::add_bytes(const void* bytes, std::size_t count)
{
    if (count > 0) XXH3_128bits_update(state_->state, bytes, count);
}

std::string StateHash::hex() const
{
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_->state));
    std::string text;
    for (unsigned char byte : canonical.digest) {
        text += "0123456789abcdef"[byte >> 4];
        text += "0123456789abcdef"[byte & 15];
    }
    return text;
}

}  // namespace analysis
