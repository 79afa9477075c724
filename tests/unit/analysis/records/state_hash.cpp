// Reference: the test vector of XXH3 128 for empty input with seed 0 (xxHash's own sanity test), and the command `xxhsum -H2` for a file.
#include "analysis/records/state_hash.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using analysis::StateHash;

TEST(StateHash, OfNothingIsTheKnownAnswer)
{
    EXPECT_EQ(StateHash().hex(), "99aa06d3014798d86001c324468d497f");
}

// printf abc | xxhsum -H2
TEST(StateHash, OfBytesIsTheKnownAnswer)
{
    StateHash hash;
    hash.add_bytes("abc", 3);
    EXPECT_EQ(hash.hex(), "06b05ab6733a618578af5f94892f3950");
}

TEST(StateHash, DependsOnTheOrderOfFramesAndOnTheLastBit)
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
}

TEST(StateHash, GoesOnAfterBeingRead)
{
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
