// An array of rows x, y, z and one more number, as the kernels need it: 64 bytes aligned, and whole blocks of sixteen rows.
#pragma once

#include <vector>

namespace pbs {

inline constexpr int rows_of_block = 16;

template <typename Scalar>
class Rows {
public:
    Rows() = default;
    explicit Rows(int rows) : blocks_((rows + rows_of_block - 1) / rows_of_block, Block{}) {}  // zeros

    Scalar* data() { return blocks_.empty() ? nullptr : blocks_.front().numbers; }
    const Scalar* data() const { return blocks_.empty() ? nullptr : blocks_.front().numbers; }
    Scalar* operator[](int row) { return data() + 4 * row; }
    const Scalar* operator[](int row) const { return data() + 4 * row; }
    int size() const { return static_cast<int>(blocks_.size()) * rows_of_block; }

private:
    struct alignas(64) Block {
        Scalar numbers[4 * rows_of_block];
    };
    std::vector<Block> blocks_;
};

}  // namespace pbs
