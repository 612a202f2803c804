#include "paper_figures/selection.h"

#include <gmock/gmock.h>

#include "paper_figures/groups.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::selection_test {

using testing::ElementsAre;

class SelectionTest : public FiguresTest {};

TEST_F(SelectionTest, TablesThatShareARunShowItUnderBothNames) {
  results_.append(record_of(plan_run("plain", "ring"), 0.2));
  results_.append(record_of(plan_run("other", "ring"), 0.4));
  plan_.by_label["twin"] = {0};
  const FigureTable& table = add_figure("both", "table", {"plain", "twin"});
  const std::vector<SelectedRun> runs = select_runs(table, plan_, results_.read().records);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].label, "plain");
  EXPECT_EQ(runs[1].label, "twin");
  EXPECT_EQ(runs[0].planned, runs[1].planned);
  const std::vector<RunGroup> groups = group_runs(runs);
  std::vector<std::string> titles;
  for (const RunGroup& group : groups) {
    titles.push_back(group.title);
    EXPECT_EQ(average_over_exemplars(group, "rme").value, 0.2);
  }
  EXPECT_THAT(titles, ElementsAre("plain", "twin"));
}

}  // namespace textonbench::selection_test
