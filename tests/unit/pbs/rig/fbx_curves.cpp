// Reference: the flags of keys as the format stores them: 2 constant, 4 linear, 8 cubic; Blender's linear keys have the flags 24836.
#include "pbs/rig/fbx_curves.hpp"

#include <gtest/gtest.h>

#include <zlib.h>

#include <cstdint>
#include <vector>

namespace {

std::string text_of(const std::string& flags)
{
    return "AnimationCurve: 11 {\nKeyAttrFlags: *1 {\n\ta: " + flags + "\n}\nKeyAttrDataFloat: *4 {\na: 0,0,8,0\n}\n}\n";
}

std::string word(std::uint32_t number)
{
    return std::string(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string binary_of(const std::vector<std::int32_t>& flags, bool is_packed)
{
    std::string data(reinterpret_cast<const char*>(flags.data()), sizeof(std::int32_t) * flags.size());
    if (is_packed) {
        std::string packed(compressBound(data.size()), '\0');
        uLongf size = packed.size();
        compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(data.data()), data.size());
        data = packed.substr(0, size);
    }
    return "\x0cKeyAttrFlagsi" + word(std::uint32_t(flags.size())) + word(is_packed) + word(std::uint32_t(data.size())) + data;
}

void expect_count(const std::string& bytes, int curves, int not_linear)
{
    const pbs::FbxCurves count = pbs::count_fbx_curves(bytes);
    EXPECT_EQ(count.curves, curves);
    EXPECT_EQ(count.not_linear, not_linear);
}

TEST(FbxCurves, OfATextFileAreCounted)
{
    expect_count(text_of("24836") + text_of("4") + text_of("2") + text_of("4,264,4"), 4, 2);
}

TEST(FbxCurves, OfABinaryFileAreCounted)
{
    for (const bool is_packed : {false, true})
        expect_count("Kaydara FBX Binary" + binary_of({24836}, is_packed) + binary_of({4, 8}, is_packed) + binary_of({2}, is_packed), 3, 2);
}

TEST(FbxCurves, ThatAreDamagedAreNotCounted)
{
    expect_count("", 0, 0);
    expect_count("KeyAttrFlags", 0, 0);
    expect_count("KeyAttrFlags: *1 { a: 4", 0, 0);
    const std::string whole = binary_of({4, 8}, true);
    for (std::size_t length = 0; length < whole.size(); ++length) expect_count(whole.substr(0, length), 0, 0);
    expect_count("KeyAttrFlagsi" + word(0xffffffffu) + word(0) + word(4) + word(4), 0, 0);
    expect_count("KeyAttrFlagsi" + word(2) + word(0) + word(4) + word(4), 0, 0);
}

}  // namespace
