// Numbers, names and arrays taken from the bytes of an input: an array is its count, in 8 bytes, and its numbers.
//   TakenBytes taken(bytes);  taken.take<int>();  taken.take_array<double>();  taken.whole();
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace fuzz {

// Once something does not fit, everything taken is zero or empty.
class TakenBytes {
public:
    explicit TakenBytes(const std::string& bytes) : at_(bytes.data()), left_(bytes.size()) {}

    template <typename Number>
    Number take()
    {
        Number number{};
        take_raw(&number, sizeof number);
        return number;
    }
    template <typename Number>
    std::vector<Number> take_array()
    {
        const auto count = take<std::uint64_t>();
        if (count > left_ / sizeof(Number)) sound_ = false;
        std::vector<Number> numbers(sound_ ? count : 0);
        take_raw(numbers.data(), numbers.size() * sizeof(Number));
        return numbers;
    }
    // everything that was taken was there, and nothing is left over
    bool whole() const { return sound_ && left_ == 0; }

private:
    void take_raw(void* data, std::size_t size)
    {
        if (size > left_) sound_ = false;
        if (!sound_ || size == 0) return;
        std::memcpy(data, at_, size);
        at_ += size;
        left_ -= size;
    }
    const char* at_;
    std::size_t left_;
    bool sound_ = true;
};

}  // namespace fuzz
