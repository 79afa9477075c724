// An array of rows x, y, z and one more number, as the kernels need it: 64 bytes aligned, and whole blocks of sixteen rows.
#pragma once

#include "pbs/solver/batched/batch.hpp"

#include <vector>

namespace pbs {

template <typename Scalar>
class Rows {
public:
    Rows() = default;
    explicit Rows(int rows) : blocks_((rows + batch_size - 1) / batch_size, Block{}) {}  // zeros

    Scalar* data() { return blocks_.empty() ? nullptr : blocks_.front().numbers; }
    const Scalar* data() const { return blocks_.empty() ? nullptr : blocks_.front().numbers; }
    Scalar* operator[](int row) { return data() + 4 * row; }
    const Scalar* operator[](int row) const { return data() + 4 * row; }
    int size() const { return static_cast<int>(blocks_.size()) * batch_size; }

private:
    struct alignas(64) Block {
        Scalar numbers[4 * batch_size];
    };
    std::vector<Block> blocks_;
};

}  // namespace pbs
