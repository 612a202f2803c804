#include "paper_figures/chart_style.h"

#include <gtest/gtest.h>

namespace textonbench::chart_style_test {

TEST(LogarithmicTics, AreDecadesOrThreeADecadeWhereTheseAreFew) {
  EXPECT_EQ(logarithmic_tics('x', 0.5, 2000), "set xtics ('1' 1e0, '10' 1e1, '100' 1e2, '1000' 1e3)\n");
  EXPECT_EQ(logarithmic_tics('y', 16, 256), "set ytics ('20' 2e1, '50' 5e1, '100' 1e2, '200' 2e2)\n");
  EXPECT_EQ(logarithmic_tics('y', 0.004, 0.011), "set ytics ('0.005' 5e-3, '0.01' 1e-2)\n");
}

}  // namespace textonbench::chart_style_test
