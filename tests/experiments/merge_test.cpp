#include "experiments/merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "experiments/provenance.h"
#include "tests/temporary_folder.h"

namespace textonbench::merge_test {

using testing::HasSubstr;

class MergeTest : public testing::Test {
 protected:
  static Record make_record(const std::string& id, const std::string& finished) {
    return {{"schema", 1}, {"id", id}, {"status", "ok"}, {"time", {{"finished", finished}}}};
  }
  /// The record with a picture of that content, kept in `from_`.
  Record with_picture(Record record, const std::string& content) const {
    const std::filesystem::path draft = from_folder_.path() / "x.png";
    std::ofstream(draft) << content;
    record["pictures"]["sample"] = {{"file", from_.keep_picture(draft)}, {"width", 1}, {"height", 1}};
    return record;
  }
  bool here(const std::string& name) const { return std::filesystem::exists(to_folder_.path() / name); }

  TemporaryFolder from_folder_, to_folder_;
  ResultsFolder from_{from_folder_.path()}, to_{to_folder_.path()};
};

TEST_F(MergeTest, AddsWhatIsNotHereAndNothingTwice) {
  to_.append(make_record("a", "monday"));
  from_.append(make_record("a", "monday"));
  from_.append(make_record("a", "tuesday"));
  from_.append(make_record("b", "monday"));
  from_.append(make_record("b", "monday"));
  const MergeSummary summary = merge_records(from_.path(), to_);
  EXPECT_EQ(summary.added, 2U);
  EXPECT_EQ(summary.present, 2U);
  EXPECT_EQ(to_.read().records.size(), 3U);
  const MergeSummary again = merge_records(from_.path() / "records.jsonl", to_);
  EXPECT_EQ(again.added, 0U);
  EXPECT_EQ(again.present, 4U);
}

TEST_F(MergeTest, CopiesPicturesAndSourceDiffs) {
  Record record = with_picture(make_record("a", "monday"), "a picture");
  const std::string diff = sha256("a diff");
  from_.keep_text("provenance/" + diff + ".diff", "a diff");
  record["provenance"]["git_diff"] = diff;
  record["log"] = "logs/a.stderr";
  from_.append(record);
  from_.append(with_picture(make_record("b", "monday"), "a picture"));
  const MergeSummary summary = merge_records(from_.path(), to_);
  EXPECT_EQ(summary.pictures_copied, 1U);
  EXPECT_EQ(summary.pictures_missing, 0U);
  EXPECT_TRUE(here(record["pictures"]["sample"]["file"].get<std::string>()));
  EXPECT_TRUE(here("provenance/" + diff + ".diff"));
  EXPECT_FALSE(to_.read().records[0].contains("log")) << "logs stay where they are";
}

TEST_F(MergeTest, PicturesThatAreMissingOrDamagedOrElsewhereAreNotCopied) {
  const Record damaged = with_picture(make_record("a", "monday"), "a picture");
  const std::string file = damaged["pictures"]["sample"]["file"].get<std::string>();
  std::ofstream(from_.path() / file) << "other bytes";
  from_.append(damaged);
  Record missing = make_record("b", "monday");
  missing["pictures"]["sample"]["file"] = "pictures/" + sha256("nothing") + ".png";
  from_.append(missing);
  Record outside = make_record("c", "monday");
  outside["pictures"]["sample"]["file"] = "../" + sha256("x") + ".png";
  from_.append(outside);
  const MergeSummary summary = merge_records(from_.path(), to_);
  EXPECT_EQ(summary.added, 3U);
  EXPECT_EQ(summary.pictures_copied, 0U);
  EXPECT_EQ(summary.pictures_missing, 3U);
  EXPECT_FALSE(here(file));
}

TEST_F(MergeTest, BadLinesAreToldAndASourceThatIsNotThereIsNamed) {
  std::ofstream(from_.path() / "records.jsonl") << "{\"schema\": 1, \"id\"\n"
                                                << make_record("a", "monday").dump() << "\n";
  const MergeSummary summary = merge_records(from_.path(), to_);
  EXPECT_EQ(summary.added, 1U);
  ASSERT_EQ(summary.bad_lines.size(), 1U);
  EXPECT_EQ(summary.bad_lines[0].line, 1U);
  try {
    merge_records("nowhere", to_);
    FAIL() << "expected an exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("nowhere: expected a records file"));
  }
}

}  // namespace textonbench::merge_test
