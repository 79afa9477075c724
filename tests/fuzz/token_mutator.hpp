// Mutations that keep most of a text's form: libFuzzer's own ones break the quotes and brackets of an XML or FBX file,
// and the library refuses nearly all of them. A token (a number, or a word) is replaced by a token of the same text, by
// an unusual number or by nothing; or some bytes of a binary file are replaced by those of an unusual number.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most) __attribute__((weak));

namespace fuzz {

struct Token {
    std::size_t begin = 0, length = 0;
};

inline bool is_of_token(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+' || c == '_' || c == '#';
}

inline std::vector<Token> tokens_of(const std::string& text, std::size_t from)
{
    std::vector<Token> tokens;
    for (std::size_t at = from; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && is_of_token(text[end])) ++end;
        if (end > at) tokens.push_back({at, end - at});
        at = std::max(end, at + 1);
    }
    return tokens;
}

inline std::string unusual_number(std::minstd_rand& random)
{
    static const std::array<const char*, 16> numbers = {
        "0",    "-1",    "1",          "2",          "3",           "99",  "65536", "1e-38",
        "1e39", "-1e30", "2147483647", "4294967295", "-2147483648", "nan", "inf",   "0.5"};
    return numbers[random() % numbers.size()];
}

inline void mutate_text(std::string& text, std::size_t from, std::minstd_rand& random)
{
    const std::vector<Token> tokens = tokens_of(text, from);
    if (tokens.empty()) return;
    const Token chosen = tokens[random() % tokens.size()], other = tokens[random() % tokens.size()];
    const unsigned kind = random() % 8;
    if (kind == 0) text.erase(chosen.begin, chosen.length);
    if (kind == 1) text.insert(chosen.begin, text.substr(other.begin, other.length) + " ");
    if (kind == 2 || kind == 3) text.replace(chosen.begin, chosen.length, text.substr(other.begin, other.length));
    if (kind > 3) text.replace(chosen.begin, chosen.length, unusual_number(random));
}

inline void mutate_bytes(std::string& bytes, std::size_t from, std::minstd_rand& random)
{
    static const std::array<std::int64_t, 8> integers = {0, 1, -1, 255, 65536, 2147483647, -2147483648LL, 1LL << 40};
    const std::size_t width = std::size_t(1) << random() % 4;
    if (bytes.size() < from + width) return;
    std::memcpy(bytes.data() + from + random() % (bytes.size() - from - width + 1),
                &integers[random() % integers.size()], width);
}

// from: the first byte of the text. One mutation in eight is libFuzzer's.
inline std::size_t mutated_tokens(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed,
                                  std::size_t from)
{
    std::minstd_rand random(seed);
    random.discard(3);
    if (size <= from || random() % 8 == 0) return LLVMFuzzerMutate(data, size, most);
    std::string text(reinterpret_cast<const char*>(data), size);
    const bool is_binary = text.find('\0', from) != std::string::npos;
    for (unsigned left = 1 + random() % 3; left > 0; --left)
        is_binary ? mutate_bytes(text, from, random) : mutate_text(text, from, random);
    text.resize(std::min(text.size(), most));
    std::memcpy(data, text.data(), text.size());
    return text.size();
}

}  // namespace fuzz
