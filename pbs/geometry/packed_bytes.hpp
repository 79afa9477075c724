// Numbers, names and arrays as bytes, for what a child process reads and its parent takes over (child_process.hpp). The taker checks
// every size against the bytes that are there before it makes room for it.
//   PackedBytes bytes;  bytes.put(3);  bytes.put_array(x.data(), x.size());
//   TakenBytes taken(bytes.text());  taken.take<int>();  taken.take_array<double>();  taken.whole();
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace pbs {

// Values are in the byte order of the machine: for processes of one machine.
class PackedBytes {
public:
    // Appends the value as it is in memory.
    template <typename Number>
    void put(Number number)
    {
        put_raw(&number, sizeof number);
    }
    // Its count, then its numbers.
    template <typename Number>
    void put_array(const Number* numbers, std::size_t count)
    {
        put(static_cast<std::uint64_t>(count));
        put_raw(numbers, count * sizeof(Number));
    }
    void put_text(const std::string& text) { put_array(text.data(), text.size()); }  // as an array of char
    const std::string& text() const { return bytes_; }                               // all that was put

private:
    void put_raw(const void* data, std::size_t size)
    {
        if (size > 0) bytes_.append(static_cast<const char*>(data), size);
    }
    std::string bytes_;
};

// Once something does not fit, everything taken is zero or empty and sound() is false.
class TakenBytes {
public:
    // `bytes` has to outlive it.
    explicit TakenBytes(const std::string& bytes) : bytes_(bytes) {}

    // The next number; its type is the caller's word.
    template <typename Number>
    Number take()
    {
        Number number{};
        take_raw(&number, sizeof number);
        return number;
    }
    // Reads what put_array wrote; empty where fewer bytes are left than its count requires.
    template <typename Number>
    std::vector<Number> take_array()
    {
        static_assert(std::is_trivially_copyable_v<Number>);
        const std::uint64_t count = take<std::uint64_t>();
        if (count > (bytes_.size() - at_) / sizeof(Number)) sound_ = false;
        std::vector<Number> numbers(sound_ ? count : 0);
        take_raw(numbers.data(), numbers.size() * sizeof(Number));
        return numbers;
    }
    // Reads what put_text wrote.
    std::string take_text()
    {
        const std::vector<char> text = take_array<char>();
        return {text.begin(), text.end()};
    }
    bool sound() const { return sound_; }                          // everything requested so far was present
    bool whole() const { return sound_ && at_ == bytes_.size(); }  // and nothing is left over

private:
    void take_raw(void* data, std::size_t size)
    {
        if (size > bytes_.size() - at_) sound_ = false;
        if (!sound_ || size == 0) return;
        std::memcpy(data, bytes_.data() + at_, size);
        at_ += size;
    }
    const std::string& bytes_;
    std::size_t at_ = 0;
    bool sound_ = true;
};

}  // namespace pbs
