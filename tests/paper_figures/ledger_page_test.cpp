#include "paper_figures/ledger_page.h"

#include <gmock/gmock.h>

#include "tests/paper_figures/fixture.h"

namespace textonbench::ledger_page_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class LedgerPageTest : public FiguresTest {
 protected:
  LedgerPageTest() {
    for (Claim* claim : {&decided_, &waiting_}) {
      claim->paper = "Lectures <2022>";
      claim->where = "p. 3";
      claim->kind = "identity";
      claim->paper_value = "0";
      claim->how = "by measuring";
    }
    decided_.id = "S1";
    decided_.statement = "a < b & c";
    decided_.caveat = "float32";
    decided_.test = ClaimTest{
        .config = "c", .config_place = {}, .measure = {}, .against = std::nullopt, .expect = {.low = 0.25, .high = 1}};
    decided_.test->measure.run = "rpn";
    decided_.test->measure.metric = "rme";
    waiting_.id = "S2";
    waiting_.statement = "later";
  }
  std::string write() const {
    const std::vector<ClaimOutcome> outcomes{{.claim = &decided_,
                                              .verdict = ClaimVerdict::reproduced_with_caveat,
                                              .reason = "",
                                              .measured = Estimate{0.5, 0.4, 0.6},
                                              .records = {"0123456789abcdef"},
                                              .command = "textonbench run c"},
                                             {.claim = &waiting_,
                                              .verdict = ClaimVerdict::not_run,
                                              .reason = "needs a GPU",
                                              .measured = std::nullopt,
                                              .records = {},
                                              .command = ""}};
    const std::filesystem::path page = write_ledger_page(outcomes, results_);
    EXPECT_EQ(page, folder_ / "report" / "claims.html");
    return read_file(page);
  }
  Claim decided_, waiting_;
};

TEST_F(LedgerPageTest, ShowsEachClaimWithItsVerdictRecordAndCommand) {
  const std::string page = write();
  EXPECT_THAT(page, AllOf(HasSubstr("a &lt; b &amp; c"), HasSubstr("reproduced with a caveat"),
                          HasSubstr("href=\"index.html#r-0123456789abcdef\""), HasSubstr("textonbench run c"),
                          HasSubstr("[0.4000, 0.6000]"), HasSubstr("rme of rpn: expected in [0.25, 1]"),
                          HasSubstr("needs a GPU"), HasSubstr("Lectures &lt;2022&gt;")));
  EXPECT_THAT(page, AllOf(HasSubstr("data-verdict=\"reproduced-with-a-caveat\""), HasSubstr("id=\"claim-filter\"")));
}

TEST_F(LedgerPageTest, LoadsNothingFromElsewhere) {
  EXPECT_THAT(write(), AllOf(Not(HasSubstr("://")), Not(HasSubstr("src=")), Not(HasSubstr("<link"))));
}

TEST_F(LedgerPageTest, IsTheSameForTheSameOutcomes) { EXPECT_EQ(write(), write()); }

}  // namespace textonbench::ledger_page_test
