// Clopper and Pearson's interval of a share: those shares p under which `counted` of `all` independent cells, or fewer, or more, are not
// rarer than (1 - level) / 2. It never covers less than `level`.
//   const ShareInterval share = share_interval(3, 18);   // 3 / 18, between 0.036 and 0.41
#pragma once

namespace experiments {

struct ShareInterval {
    double value = 0.0, low = 0.0, high = 0.0;
};

// 0 <= counted <= all, all > 0.
ShareInterval share_interval(int counted, int all, double level = 0.95);

}  // namespace experiments
