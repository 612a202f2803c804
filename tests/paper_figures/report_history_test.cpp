#include "paper_figures/report_history.h"

#include <gmock/gmock.h>

#include "tests/paper_figures/fixture.h"

namespace textonbench::report_history_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class HistoryTest : public FiguresTest {
 protected:
  std::string page(const std::string& lines) const {
    write_atomically(folder_ / "history.jsonl", lines);
    return history_html(folder_ / "history.jsonl");
  }
};

TEST_F(HistoryTest, TellsChangesSinceTheBaselineBefore) {
  const std::string html = page(
      R"({"date": "2026-01-01T00:00:00Z", "version": "0.1.0", "git_commit": "0123456789abcdef", "reason": "first", "runs": 3, "metrics": {"rme": 0.5}})"
      "\n"
      R"({"date": "2026-02-01T00:00:00Z", "version": "0.2.0", "git_commit": "fedcba9876543210", "reason": "<better>", "runs": 4, "metrics": {"rme": 0.4, "skewness": 0.01}})"
      "\n");
  EXPECT_THAT(html, AllOf(HasSubstr("-20.0 %"), HasSubstr("&lt;better&gt;"), HasSubstr("fedcba987654"),
                          HasSubstr("Skewness"), Not(HasSubstr("Excess kurtosis"))));
  EXPECT_LT(html.find("2026-02-01"), html.find("2026-01-01"));
}

TEST_F(HistoryTest, ABadLineIsToldInItsPlace) {
  const std::string html = page("{\"date\": \"2026-01-01\", \"metrics\": {\"rme\": 0.5}}\n{\"date\": \n");
  EXPECT_THAT(html, AllOf(HasSubstr("history.jsonl:2"), HasSubstr("0.5000")));
}

TEST_F(HistoryTest, WithoutHistoryThereIsNoSection) {
  EXPECT_EQ(history_html(folder_ / "none.jsonl"), "");
  EXPECT_EQ(page(""), "");
}

}  // namespace textonbench::report_history_test
