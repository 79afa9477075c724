// Neumaier's compensated sum. Its result hardly depends on the order of the terms, and never on the number of threads.
//   CompensatedSum sum;  for (double term : terms) sum += term;  double total = sum.value();
#pragma once

#include <cmath>

namespace analysis {

// A. Neumaier, Z. Angew. Math. Mech. 54, 1974.
class CompensatedSum {
public:
    // Adds any double; a term that is not finite makes the sum not finite.
    CompensatedSum& operator+=(double term)
    {
        const double next = sum_ + term;
        lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
        sum_ = next;
        return *this;
    }
    double value() const { return std::isfinite(lost_) ? sum_ + lost_ : sum_; }  // 0 without terms

private:
    double sum_ = 0.0, lost_ = 0.0;
};

}  // namespace analysis
